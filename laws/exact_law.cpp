#include "laws/exact_law.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/tolerances.hpp"
#include "core/clearance/clearance_over_time.hpp"
#include "laws/episode.hpp"
#include "laws/second_opinion.hpp"

namespace fleetproof {
namespace {

class Judge {
 public:
  Judge(const Piece& a, const Piece& b, Interval within, double fastest_before_mps, EvaluationCount& count)
      : a_(a), b_(b), within_(within), fastest_before_mps_(fastest_before_mps), count_(count) {}

  Episode file(const ClosestApproach& found) {
    if (found.clearance_m < kTouch_m + kSmallestClearance_m) {
      if (const auto touch = first_touch()) return contact(*touch);
    }
    return near(found);
  }

 private:
  double clearance_at(SimTime t) {
    ++count_.distance;
    return clearance_m(a_.body_at(t), b_.body_at(t));
  }

  // The world measures where a piece begins, and looks for kTouch_m in between.
  std::optional<SimTime> first_touch() {
    if (clearance_at(within_.begin) < kTouch_m) return within_.begin;
    std::optional<SimTime> below = first_below(a_, b_, within_, kContact_m, count_);
    if (!below && clearance_at(within_.end) < kTouch_m) below = within_.end;
    if (!below) return std::nullopt;
    return first_below(a_, b_, {within_.begin, *below}, kTouch_m, count_).value_or(*below);
  }

  Episode contact(SimTime touch) {
    const SimTime end = last_below(a_, b_, {touch, within_.end}, kTouch_m, count_).value_or(touch);
    return filed({clearance_at(touch), touch}, true,
                 fastest_below(a_, b_, {touch, end}, kTouch_m, count_, fastest_before_mps_));
  }

  Episode near(const ClosestApproach& found) {
    const double level_m = found.clearance_m + kSameClearance_m;
    const SimTime before = first_below(a_, b_, {within_.begin, found.at}, level_m, count_).value_or(found.at),
                  after = last_below(a_, b_, {found.at, within_.end}, level_m, count_).value_or(found.at);
    const SimTime first = bottom(before, after), last = std::max(first, bottom(after, first));
    return filed({clearance_at(first), first}, false,
                 fastest_below(a_, b_, {first, last}, clearance_at(first) + kSameClearance_m, count_));
  }

  // From an instant towards another: the first instant at which the clearance no longer falls.
  SimTime bottom(SimTime from, SimTime to) {
    const TimeSense sense = to < from ? TimeSense::Backward : TimeSense::Forward;
    const auto falls = [&](SimTime t) {
      ++count_.distance;
      return clearance_rate_mps(a_, b_, t, sense) < -kStationary_mps;
    };
    const std::int64_t all_ns = std::abs((to - from).count());
    const auto at = [&](std::int64_t ns) { return from + Duration{static_cast<int>(sense) * ns}; };
    if (all_ns == 0 || !falls(from)) return from;
    std::int64_t falling = 0, next = 1;
    while (next < all_ns && falls(at(next))) {
      falling = next;
      next *= 2;
    }
    next = std::min(next, all_ns);
    while (next - falling > 1) {
      const std::int64_t middle = falling + (next - falling) / 2;
      (falls(at(middle)) ? falling : next) = middle;
    }
    return at(next);
  }

  Episode filed(const ClosestApproach& closest, bool touches, const RelativeSpeed& speed) const {
    Episode episode = episode_of(a_, b_, within_.begin, within_.end, closest);
    episode.contact = touches;
    episode.speed = speed;
    return episode;
  }

  const Piece& a_;
  const Piece& b_;
  Interval within_;
  double fastest_before_mps_;
  EvaluationCount& count_;
};

// An episode of two pieces as the exact law files it. `closest` is the closest approach that the search has found.
//
// If the bodies touch, the closest instant is the first touch, as the world dates it; the speed is the highest during
// the contact. Else the closest instant is the bottom of the first minimum of the least clearance, and the speed is the
// highest while the clearance stays the same. The speed of a contact that is slower than `fastest_before_mps` is not
// worked out: an earlier contact of the same episode was faster.
// Requires: both pieces cover [first, last]; the clearance is below the threshold at both ends.
Episode judged_episode(const Piece& one, const Piece& other, Interval within, const ClosestApproach& closest,
                       double fastest_before_mps, EvaluationCount& count) {
  return Judge(one, other, within, fastest_before_mps, count).file(closest);
}

constexpr double kMeasuredBelow_m = 0.5;
// Of two walks that end at one seam, each from its side, each may be a nanosecond short of it.
constexpr Duration kSeam{2};
constexpr Duration kRiseNoticed = std::chrono::milliseconds(100);

class ExactLaw final : public Law {
 public:
  explicit ExactLaw(const Scenario& scenario)
      : agv_count_(scenario.agvs.size()),
        threshold_m_(violation_threshold_m(scenario.law)),
        bodies_(scenario.entity_count()) {}

  double looks_within_m() const override { return std::max(kMeasuredBelow_m, threshold_m_); }
  Pieces hears_pieces() const override { return Pieces::Ends; }
  void had_company(const Piece& piece, std::span<const Piece* const> others) override;
  void piece_ended(const Piece& piece) override;
  void finish(SimTime end) override;
  LawResults findings() const override;

 private:
  void file(const Piece& a, const Piece& b, Interval within, const ClosestApproach& closest);
  void settle(const Piece& a, const Piece& b, Interval within);
  void settle_standing(const Piece& a, const Piece& b, Interval within);
  void settle_moving(const Piece& a, const Piece& b, Interval within);
  void collect_episodes(const Piece& a, const Piece& b, const ApproachBelow& approach, SimTime last);
  void collect(const Piece& a, const Piece& b, SimTime first, SimTime last);
  double threshold_m(const Piece& a, const Piece& b) const { return threshold_m_ - allowance_on_curves_m(a, b); }
  double clearance_at(const Piece& a, const Piece& b, SimTime t);
  // Since when the body of this piece, its newest, has been on the floor with this outline: it may appear, and a load
  // may make it wider.
  SimTime on_floor_since(const Piece& piece) const {
    const OnFloor& before = bodies_[piece.entity.index()];
    return before.until == piece.begin && before.footprint == piece.footprint ? before.since : piece.begin;
  }

  std::size_t agv_count_;
  double threshold_m_;
  double smallest_m_ = kMeasuredBelow_m;
  // Of a body, as of its last piece that is over: since when it was on the floor without a break and with the same
  // outline, and the end.
  struct OnFloor {
    SimTime since = SimTime::min(), until = SimTime::min();
    Footprint footprint;
  };
  std::vector<OnFloor> bodies_;
  EvaluationCount evaluations_;
  EvaluationCount describing_;  // spent on violations that are found already: no cost of detection, not reported
  std::vector<Episode> episodes_;
  // Of a pair, in the episode that ends last.
  struct Contacts {
    SimTime until = kStart;
    double fastest_mps = 0.0;
  };
  std::map<std::pair<EntityId, EntityId>, Contacts> contacts_;
};

void ExactLaw::had_company(const Piece& piece, std::span<const Piece* const> others) {
  const std::size_t mine = piece.entity.index();
  const Box near = piece.planned_box.grown(std::max(smallest_m_, threshold_m_));
  for (const Piece* const other : others) {
    const std::size_t its = other->entity.index();
    if (mine >= agv_count_ && its >= agv_count_) continue;  // two obstacles cannot violate anything
    if (!near.overlaps(other->planned_box)) continue;
    const Interval common{std::max(piece.begin, other->begin), piece.end};
    // The same order of the pair whichever piece ends first, so that the order of announcements leaves no trace in the
    // arithmetic.
    if (mine < its) {
      settle(piece, *other, common);
    } else {
      settle(*other, piece, common);
    }
  }
}

void ExactLaw::piece_ended(const Piece& piece) {
  ensure(piece.entity.index() < bodies_.size(), "a law hears only of the bodies of its scenario");
  bodies_[piece.entity.index()] = {on_floor_since(piece), piece.end, piece.footprint};
}

void ExactLaw::settle(const Piece& a, const Piece& b, Interval within) {
  const bool instant = within.begin == within.end;
  // Unless a body has appeared or grown at this instant, it is the last one of an interval already settled. If one has,
  // the piece that ends here says how fast it was struck: the next one may stand already.
  const bool is_new = std::max(on_floor_since(a), on_floor_since(b)) == within.begin;
  if (instant && !is_new) return;
  if (instant || (a.manner == Manner::Rest && b.manner == Manner::Rest)) {
    settle_standing(a, b, within);
  } else {
    settle_moving(a, b, within);
  }
}

void ExactLaw::settle_standing(const Piece& a, const Piece& b, Interval within) {
  const double clearance = clearance_at(a, b, within.begin);
  smallest_m_ = std::min(smallest_m_, clearance);
  if (clearance < threshold_m(a, b))
    episodes_.push_back(episode_of(a, b, within.begin, within.end, {clearance, within.begin}));
}

void ExactLaw::settle_moving(const Piece& a, const Piece& b, Interval within) {
  // Most pairs stay farther apart than the smallest clearance so far, and that settles both questions. Earlier findings
  // have no other influence. A violation is dated and measured from the start of the interval. Therefore the result
  // does not depend on the order in which pieces are announced.
  const double level_m = threshold_m(a, b);
  const bool lower = smallest_m_ > level_m + kBuiltToTheLimit_m;
  if (lower && !comes_below(a, b, within, smallest_m_, evaluations_)) return;
  if (const auto approach = approach_below(a, b, within, level_m, evaluations_)) {
    smallest_m_ = std::min(smallest_m_, approach->closest.clearance_m);
    const auto last = last_below(a, b, {approach->first, within.end}, level_m, evaluations_);
    // The search finds a dip of a nanometre from one side in time, but not from the other side.
    collect_episodes(a, b, *approach, std::max(last.value_or(approach->first), approach->closest.at));
  } else if (lower) {
    const auto closest = closest_approach(a, b, within, smallest_m_, evaluations_);
    if (closest) smallest_m_ = std::min(smallest_m_, closest->clearance_m);
  }
}

// Every rise of kRiseNoticed or longer contains a probe. Exit and return are then found exactly, before and after the
// probe.
void ExactLaw::collect_episodes(const Piece& a, const Piece& b, const ApproachBelow& approach, SimTime last) {
  const double level_m = threshold_m(a, b);
  SimTime first = approach.first;
  for (SimTime probe = first + kRiseNoticed; probe < last; probe += kRiseNoticed) {
    if (clearance_at(a, b, probe) < level_m) continue;
    collect(a, b, first, last_below(a, b, {first, probe}, level_m, evaluations_).value_or(first));
    first = first_below(a, b, {probe, last}, level_m, evaluations_).value_or(last);
    probe = first;
  }
  if (first > approach.first) return collect(a, b, first, last);
  file(a, b, {first, last}, approach.closest);
}

void ExactLaw::collect(const Piece& a, const Piece& b, SimTime first, SimTime last) {
  auto closest = closest_approach(a, b, {first, last}, threshold_m(a, b), evaluations_);
  if (!closest)
    closest = ClosestApproach{clearance_at(a, b, first), first};  // a graze shallower than the search resolves
  file(a, b, {first, last}, *closest);
}

// Bodies that no contact stops touch each other over many pieces, which are one episode in the end.
void ExactLaw::file(const Piece& a, const Piece& b, Interval within, const ClosestApproach& closest) {
  Contacts& contacts = contacts_[{a.entity, b.entity}];
  if (within.begin - contacts.until > kSeam) contacts.fastest_mps = 0.0;
  episodes_.push_back(judged_episode(a, b, within, closest, contacts.fastest_mps, describing_));
  contacts.until = within.end;
  if (episodes_.back().contact) contacts.fastest_mps = std::max(contacts.fastest_mps, episodes_.back().speed.speed_mps);
}

double ExactLaw::clearance_at(const Piece& a, const Piece& b, SimTime t) {
  ++evaluations_.distance;
  return clearance_m(a.body_at(t), b.body_at(t));
}

void ExactLaw::finish(SimTime) {
  episodes_ = joined(std::move(episodes_), kSeam);
  for (const Episode& episode : episodes_)
    confirm_clearance(episode.body_a, episode.body_b, episode.closest.clearance_m);
}

LawResults ExactLaw::findings() const {
  LawResults findings;
  findings.violations = filed(episodes_);
  if (smallest_m_ < kMeasuredBelow_m) findings.min_clearance_m = std::max(0.0, smallest_m_);
  findings.distance_evaluations = evaluations_.distance;
  findings.perimeter_checks = evaluations_.distance;
  return findings;
}

}  // namespace

std::unique_ptr<Law> make_exact_law(const Scenario& scenario) { return std::make_unique<ExactLaw>(scenario); }

}  // namespace fleetproof
