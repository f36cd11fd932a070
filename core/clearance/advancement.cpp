#include "core/clearance/advancement.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/base/tolerances.hpp"
#include "core/clearance/gap_bound.hpp"

namespace fleetproof {
namespace {

// A gap is followed along an old direction until it has lost this share of the clearance that was measured with the
// direction. Then the clearance is measured again.
constexpr double kWorn = 0.5;

class Walk {
 public:
  Walk(const Piece& a, const Piece& b, SimTime from, SimTime to, double level_m, EvaluationCount& count)
      : a_(a),
        b_(b),
        to_(to),
        sense_(to < from ? TimeSense::Backward : TimeSense::Forward),
        level_m_(level_m),
        count_(count) {
    arrive(from);
  }

  // `start`: the measurement at the beginning of the walk.
  std::optional<Hit> run(Dating dating, const Separation* start = nullptr) {
    if (start == nullptr) {
      measure();
    } else {
      apart_ = *start;
      measured_ = true;
    }
    if (apart_.clearance_m < level_m_) return Hit{now_, apart_};
    while (now_ != to_) {
      jump();
      if (measured_ && apart_.clearance_m < level_m_)
        return dating == Dating::Exact ? first_of_hit() : Hit{now_, apart_};
    }
    return std::nullopt;
  }

  const Hit& lowest() const { return lowest_; }

 private:
  static std::int64_t ns_between(SimTime s, SimTime t) { return std::abs((t - s).count()); }
  static double seconds_between(SimTime s, SimTime t) { return to_seconds(Duration{ns_between(s, t)}); }
  SimTime later(SimTime t, std::int64_t by_ns) const { return t + Duration{by_ns * static_cast<int>(sense_)}; }
  // Rounded down: never beyond what has been proved.
  SimTime after(SimTime t, double wait_s) const { return later(t, static_cast<std::int64_t>(wait_s * 1e9)); }
  SimTime nearer(SimTime s, SimTime t) const { return sense_ == TimeSense::Forward ? std::min(s, t) : std::max(s, t); }

  void arrive(SimTime t) {
    now_ = t;
    body_a_ = a_.body_at(t);
    body_b_ = b_.body_at(t);
    measured_ = false;
  }

  void measure() {
    ++count_.distance;
    apart_ = separation(body_a_, body_b_);
    measured_ = true;
    if (apart_.clearance_m < lowest_.apart.clearance_m) lowest_ = {now_, apart_};
  }

  // How far a body that keeps its heading still gets along a direction before the walk ends.
  double comes_nearer_m(const Piece& piece, const OrientedRectangle& body, const Vec2& direction) const {
    if (piece.manner == Manner::Rest) return 0.0;
    const double way_m = piece.way_at(to_) - piece.way_at(now_);
    return std::max(0.0, (piece.moves_against_heading() ? -way_m : way_m) * direction.dot(body.heading));
  }

  // If bodies keep their headings, they come nearer along a direction by at most the rest of their ways, in every
  // phase.
  bool never_meets_level() const {
    if (!measured_ || !a_.keeps_heading() || !b_.keeps_heading()) return false;
    const double nearer_m =
        comes_nearer_m(a_, body_a_, apart_.direction) + comes_nearer_m(b_, body_b_, -apart_.direction);
    return apart_.clearance_m - nearer_m >= level_m_;
  }

  // Goes to the end of the phase, or to the instant at which the bound meets the level. There the clearance is measured
  // again.
  void jump() {
    if (never_meets_level()) {
      now_ = to_;
      measured_ = false;
      return;
    }
    const PhaseMotion first = motion_from(a_, body_a_, now_, to_, sense_),
                      second = motion_from(b_, body_b_, now_, to_, sense_);
    if (measured_) axis_ = Axis(apart_, first, second);
    GapBound bound(first, second, axis_);
    // An axis from an earlier instant may fit badly by now. Then the bound is near the level although the bodies are
    // not, and a new measurement pays.
    if (!measured_ && !bound.exact() && bound.now_m() - level_m_ < kWorn * (apart_.clearance_m - level_m_)) {
      measure();
      if (apart_.clearance_m < level_m_) return;
      axis_ = Axis(apart_, first, second);
      bound = GapBound(first, second, axis_);
    }
    from_ = now_;
    const SimTime change = nearer(first.change, second.change);
    const double left_s = seconds_between(now_, change), safe_s = bound.safe_s(level_m_ - kDip_m, left_s);
    if (safe_s >= left_s) return arrive(change);
    // From a measured instant, the least step is a nanosecond. At an instant that an old bound reached, the clearance
    // must still be measured.
    const bool fresh = measured_;
    const SimTime next = nearer(after(now_, safe_s), change);
    if (next != now_) {
      arrive(next);
    } else if (fresh) {
      arrive(later(now_, 1));
    }
    measure();
  }

  // The hit lies where the bound was a dip below the level. In a slow approach, the clearance was below the level long
  // before. Therefore bisect back to the instant at which the bound met the level.
  Hit first_of_hit() {
    Hit hit{now_, apart_};
    arrive(from_);
    const GapBound bound(motion_from(a_, body_a_, now_, hit.at, sense_), motion_from(b_, body_b_, now_, hit.at, sense_),
                         axis_);
    SimTime above = after(now_, bound.safe_s(level_m_, seconds_between(now_, hit.at)));
    while (ns_between(above, hit.at) > 1) {
      arrive(above + (hit.at - above) / 2);
      measure();
      if (apart_.clearance_m < level_m_) {
        hit = {now_, apart_};
      } else {
        above = now_;
      }
    }
    return hit;
  }

  const Piece& a_;
  const Piece& b_;
  SimTime now_, to_;
  TimeSense sense_;
  double level_m_;
  EvaluationCount& count_;
  OrientedRectangle body_a_, body_b_;
  bool measured_ = false;
  Separation apart_;  // when last measured
  Axis axis_;         // of that measurement
  SimTime from_;      // where the last jump began
  Hit lowest_{kStart, {std::numeric_limits<double>::infinity()}};
};

}  // namespace

std::optional<Hit> advance(const Piece& a, const Piece& b, SimTime from, SimTime to, double level_m,
                           EvaluationCount& count, Dating dating) {
  return Walk(a, b, from, to, level_m, count).run(dating);
}

std::optional<Hit> advance(const Piece& a, const Piece& b, const Hit& from, SimTime to, double level_m,
                           EvaluationCount& count, Dating dating, Hit& lowest) {
  Walk walk(a, b, from.at, to, level_m, count);
  const auto hit = walk.run(dating, &from.apart);
  if (walk.lowest().apart.clearance_m < lowest.apart.clearance_m) lowest = walk.lowest();
  return hit;
}

}  // namespace fleetproof
