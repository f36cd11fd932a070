#include "core/clearance/clearance_over_time.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/tolerances.hpp"
#include "core/clearance/advancement.hpp"
#include "core/clearance/gap_bound.hpp"

namespace fleetproof {
namespace {

// The smallest clearance of a pair. A descent along rates and values gives an upper bound. Advancement then proves the
// bound, or finds a smaller clearance.
class ClosestSearch {
 public:
  ClosestSearch(const Piece& a, const Piece& b, double tolerance_m, EvaluationCount& count)
      : a_(a), b_(b), tolerance_m_(tolerance_m), count_(count) {}

  // `low`: where the search begins. Since `begin`, no earlier instant has a smaller clearance. If the bodies touch,
  // `low` is the first touch.
  Hit run(SimTime begin, const Hit& low, SimTime end);

 private:
  // A measured instant, and the rate of the clearance there, in the direction of the walk.
  struct Sample {
    Hit hit;
    double rate_mps = 0.0;
    double clearance_m() const { return hit.apart.clearance_m; }
  };
  // Where the gap along a fixed axis is smallest, and whether the gap vanishes on the way.
  struct Outlook {
    SimTime at;
    bool touch = false;
  };

  Hit measure(SimTime t);
  double rate_mps(const Hit& hit, SimTime to) const;
  Outlook outlook(const Hit& from, SimTime to) const;
  void descend(const Hit& from, SimTime to);
  void narrow(Sample left, Sample right, SimTime to);
  void prove(SimTime until);
  bool below(double level_m) const { return best_.apart.clearance_m <= level_m; }

  const Piece& a_;
  const Piece& b_;
  double tolerance_m_;
  EvaluationCount& count_;
  Hit best_;
};

TimeSense sense_of(SimTime from, SimTime to) { return to < from ? TimeSense::Backward : TimeSense::Forward; }
double seconds_between(SimTime s, SimTime t) { return std::abs(to_seconds(t - s)); }
SimTime after(SimTime t, double wait_s, SimTime to) {
  const Duration wait = seconds(wait_s);
  return to < t ? std::max(to, t - wait) : std::min(to, t + wait);
}

Hit ClosestSearch::run(SimTime begin, const Hit& low, SimTime end) {
  best_ = low;
  if (below(0.0)) return low.at == begin ? low : advance(a_, b_, begin, low.at, kOverlap_m, count_).value_or(low);
  const Outlook ahead = outlook(low, end);
  if (ahead.touch) {
    if (const auto touch = advance(a_, b_, low, end, kOverlap_m, count_, Dating::Exact, best_)) return *touch;
    descend(best_, end);
  } else {
    descend(low, end);
  }
  // Outward from the minimum, where the gap along the direction of closest approach is stationary: most often one jump
  // to either side.
  prove(low.at);
  prove(end);
  if (!below(0.0)) return best_;
  Hit ignored = best_;
  return advance(a_, b_, low, best_.at, kOverlap_m, count_, Dating::Exact, ignored).value_or(best_);
}

Hit ClosestSearch::measure(SimTime t) {
  ++count_.distance;
  const Hit hit{t, separation(a_.body_at(t), b_.body_at(t))};
  if (!below(hit.apart.clearance_m)) best_ = hit;
  return hit;
}

double ClosestSearch::rate_mps(const Hit& hit, SimTime to) const {
  const TimeSense sense = sense_of(hit.at, to);
  const PhaseMotion first = motion_from(a_, a_.body_at(hit.at), hit.at, to, sense),
                    second = motion_from(b_, b_.body_at(hit.at), hit.at, to, sense);
  return GapBound(first, second, Axis(hit.apart, first, second)).trend().rate_mps;
}

ClosestSearch::Outlook ClosestSearch::outlook(const Hit& from, SimTime to) const {
  const TimeSense sense = sense_of(from.at, to);
  Axis axis;
  for (SimTime t = from.at; t != to;) {
    const PhaseMotion first = motion_from(a_, a_.body_at(t), t, to, sense),
                      second = motion_from(b_, b_.body_at(t), t, to, sense);
    if (t == from.at) axis = Axis(from.apart, first, second);
    const auto [value, rate, bend] = GapBound(first, second, axis).trend();
    if (value <= 0.0) return {t, true};
    if (rate >= 0.0) return {t};
    const SimTime change =
        sense == TimeSense::Forward ? std::min(first.change, second.change) : std::max(first.change, second.change);
    const double left_s = seconds_between(t, change), turn_s = bend > 0.0 ? -rate / bend : left_s,
                 x = std::min(turn_s, left_s);
    if (value + x * (rate + 0.5 * x * bend) <= 0.0) return {after(t, x, change), true};
    if (turn_s < left_s) return {after(t, turn_s, change)};
    t = change;
  }
  return {to};
}

// From an instant towards another, downhill to a local minimum.
void ClosestSearch::descend(const Hit& from, SimTime to) {
  constexpr int kMost = 24;
  Sample here{from, rate_mps(from, to)};
  for (int i = 0; i < kMost && here.hit.at != to && here.rate_mps < 0.0; ++i) {
    const SimTime t = outlook(here.hit, to).at;
    if (t == here.hit.at) return;
    const Hit hit = measure(t);
    if (below(0.0)) return;
    const Sample next{hit, rate_mps(hit, to)};
    if (next.rate_mps >= 0.0 || next.clearance_m() > here.clearance_m()) return narrow(here, next, to);
    if (-next.rate_mps * seconds_between(here.hit.at, t) < 0.1 * tolerance_m_) return;
    here = next;
  }
}

// Between a falling instant and one beyond the minimum: cubics through values and rates, tangents where a cubic gains
// little ground (a kink), then halves.
void ClosestSearch::narrow(Sample left, Sample right, SimTime to) {
  constexpr int kMost = 24;
  int slow = 0;
  for (int i = 0; i < kMost && !below(0.0); ++i) {
    const double width = seconds_between(left.hit.at, right.hit.at), fall = left.rate_mps, rise = right.rate_mps;
    // Three guesses for the minimum. The half is safe, the kink is best for two lines, the cubic for smooth curves.
    double x = 0.5 * width;
    if (rise > 0.0) {
      // The clearance is not convex, but nearly. Therefore the point where the tangents meet is a fair estimate of the
      // possible gain.
      const double kink = (right.clearance_m() - left.clearance_m() - rise * width) / (fall - rise);
      if (kink > 0.0 && kink < width) {
        if (left.clearance_m() + fall * kink > best_.apart.clearance_m - 0.25 * tolerance_m_) return;
        if (slow == 1) x = kink;
      }
      const double d1 = fall + rise - 3.0 * (right.clearance_m() - left.clearance_m()) / width,
                   square = d1 * d1 - fall * rise;
      if (slow == 0 && square > 0.0) {
        const double d2 = std::sqrt(square);
        x = width - width * (rise + d2 - d1) / (rise - fall + 2.0 * d2);
      }
    }
    // The sample replaces the end on its side, so the minimum stays between both. If the interval shrinks by less than
    // half, the next round takes another guess.
    const SimTime t = after(left.hit.at, std::clamp(x, 0.0, width), right.hit.at);
    if (t == left.hit.at || t == right.hit.at) return;
    const Hit hit = measure(t);
    const Sample next{hit, rate_mps(hit, to)};
    (next.rate_mps >= 0.0 || next.clearance_m() > left.clearance_m() ? right : left) = next;
    slow = seconds_between(left.hit.at, right.hit.at) > 0.5 * width ? (slow + 1) % 3 : 0;
  }
}

// Proves that no instant between the best one and `until` is better.
void ClosestSearch::prove(SimTime until) {
  while (!below(0.0)) {
    const Hit from = best_;
    Hit ignored = best_;
    const auto lower =
        advance(a_, b_, from, until, from.apart.clearance_m - tolerance_m_, count_, Dating::Rough, ignored);
    if (!lower) return;
    best_ = *lower;
    descend(*lower, until);
    prove(lower->at);
  }
}

std::optional<SimTime> instant_of(const std::optional<Hit>& hit) { return hit ? std::optional(hit->at) : std::nullopt; }

std::optional<ApproachBelow> approach_below(const Piece& a, const Piece& b, Interval within, double level_m,
                                            EvaluationCount& count, double tolerance_m, Dating dating) {
  if (within.end < within.begin) return std::nullopt;
  const auto hit = advance(a, b, within.begin, within.end, level_m, count, dating);
  if (!hit) return std::nullopt;
  const Hit closest = ClosestSearch(a, b, tolerance_m, count).run(within.begin, *hit, within.end);
  return ApproachBelow{hit->at, {closest.apart.clearance_m, closest.at}};
}

}  // namespace

std::optional<SimTime> first_below(const Piece& a, const Piece& b, Interval within, double level_m,
                                   EvaluationCount& count) {
  if (within.end < within.begin) return std::nullopt;
  return instant_of(advance(a, b, within.begin, within.end, level_m, count));
}

std::optional<SimTime> last_below(const Piece& a, const Piece& b, Interval within, double level_m,
                                  EvaluationCount& count) {
  if (within.end < within.begin) return std::nullopt;
  return instant_of(advance(a, b, within.end, within.begin, level_m, count));
}

std::optional<SimTime> comes_below(const Piece& a, const Piece& b, Interval within, double level_m,
                                   EvaluationCount& count) {
  if (within.end < within.begin) return std::nullopt;
  return instant_of(advance(a, b, within.begin, within.end, level_m, count, Dating::Rough));
}

std::optional<ClosestApproach> closest_approach(const Piece& a, const Piece& b, Interval within, double below_m,
                                                EvaluationCount& count, double tolerance_m) {
  const auto approach = approach_below(a, b, within, below_m, count, tolerance_m, Dating::Rough);
  return approach ? std::optional(approach->closest) : std::nullopt;
}

std::optional<ApproachBelow> approach_below(const Piece& a, const Piece& b, Interval within, double level_m,
                                            EvaluationCount& count, double tolerance_m) {
  return approach_below(a, b, within, level_m, count, tolerance_m, Dating::Exact);
}

}  // namespace fleetproof
