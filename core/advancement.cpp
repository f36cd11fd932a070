#include "core/advancement.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace fleetproof {
namespace {

constexpr double kDip_m = 1e-9;
constexpr double kNotMet = std::numeric_limits<double>::infinity();

// Least positive root of value + rate x + bend x^2 / 2, for a positive value.
double first_root(double value, double rate, double bend) {
  const double root_of = rate * rate - 2.0 * bend * value;
  if (rate < 0.0) return root_of < 0.0 ? kNotMet : 2.0 * value / (std::sqrt(root_of) - rate);
  return bend < 0.0 ? (rate + std::sqrt(root_of)) / -bend : kNotMet;
}

// The gap between two bodies along a fixed direction, from below, while neither changes its law of motion.
class GapBound {
 public:
  GapBound(const PhaseMotion& first, const PhaseMotion& second, const Vec2& direction)
      : first_(reach(first, direction)), second_(reach(second, -direction)) {}

  bool exact() const { return first_.count == 1 && second_.count == 1; }

  double now_m() const {
    const auto extent = [](const Reach& reach) {
      double most = reach.of[0].value;
      for (std::size_t i = 1; i < reach.count; ++i) most = std::max(most, reach.of[i].value);
      return most;
    };
    return -(extent(first_) + extent(second_));
  }

  // No earlier than this many seconds from now, and up to `horizon_s`, does the bound meet the level; `horizon_s` if not before.
  double meets_s(double level_m, double horizon_s) const {
    double safe_s = meets_within_s(level_m, horizon_s);
    if (exact()) return safe_s;
    // The nearer the horizon, the better the bound: look again whether it holds a little longer than it has just proved to.
    for (int i = 0; i < kRefinements && safe_s < horizon_s; ++i) {
      safe_s = std::max(safe_s, meets_within_s(level_m, std::min(horizon_s, kLonger * safe_s)));
    }
    return safe_s;
  }

 private:
  static constexpr int kRefinements = 3;
  static constexpr double kLonger = 1.5;

  double meets_within_s(double level_m, double horizon_s) const {
    double earliest_s = horizon_s;
    for (std::size_t i = 0; i < first_.count; ++i) {
      const Extent& p = first_.of[i];
      const double p_bend = p.bend_within(horizon_s);
      for (std::size_t j = 0; j < second_.count; ++j) {
        const Extent& q = second_.of[j];
        const double value = -(p.value + q.value) - level_m, rate = -(p.rate + q.rate), bend = -(p_bend + q.bend_within(horizon_s));
        if (value <= 0.0) return 0.0;
        // Most pairs of corners cannot meet in time: no root needed.
        if (value + earliest_s * (std::min(rate, 0.0) + 0.5 * earliest_s * std::min(bend, 0.0)) > 0.0) continue;
        earliest_s = std::min(earliest_s, first_root(value, rate, bend));
      }
    }
    return earliest_s;
  }

  Reach first_, second_;
};

class Walk {
 public:
  Walk(const Piece& a, const Piece& b, SimTime from, SimTime to, double level_m, EvaluationCount& count)
      : a_(a), b_(b), now_(from), to_(to), sense_(to < from ? TimeSense::Backward : TimeSense::Forward), level_m_(level_m), count_(count) {}

  std::optional<Hit> run() {
    measure();
    if (apart_.clearance_m < level_m_) return Hit{now_, apart_.clearance_m};
    while (now_ != to_) {
      if (!jump()) continue;
      if (apart_.clearance_m < level_m_) return first_of_hit();
    }
    return std::nullopt;
  }

 private:
  SimTime later(std::int64_t by_ns) const { return now_ + Duration{by_ns * static_cast<int>(sense_)}; }
  double at_m(SimTime t) const {
    ++count_.distance;
    return separation(a_.body_at(t), b_.body_at(t)).clearance_m;
  }

  void measure() {
    ++count_.distance;
    apart_ = separation(a_.body_at(now_), b_.body_at(now_));
    measured_ = true;
  }

  std::int64_t left_ns(SimTime until) const { return std::abs((until - now_).count()); }

  // One phase, or to where the bound meets the level. True if the clearance has been measured there.
  bool jump() {
    const PhaseMotion first = motion_from(a_, now_, to_, sense_), second = motion_from(b_, now_, to_, sense_);
    const GapBound bound(first, second, apart_.direction);
    if (!measured_ && !bound.exact() && bound.now_m() - level_m_ < kWorn * (apart_.clearance_m - level_m_)) {
      measure();
      return true;
    }
    const SimTime change = sense_ == TimeSense::Forward ? std::min(first.change, second.change) : std::max(first.change, second.change);
    const double left_s = to_seconds(Duration{left_ns(change)});
    const double safe_s = bound.meets_s(level_m_ - kDip_m, left_s);
    from_ = now_;
    direction_ = apart_.direction;
    if (safe_s >= left_s) {
      now_ = change;
      measured_ = false;
      return false;
    }
    const auto safe_ns = std::min(static_cast<std::int64_t>(safe_s * 1e9), left_ns(change));
    // From a measured instant a nanosecond is the least step; at one reached by a bound there is still to measure.
    now_ = later(measured_ ? std::max<std::int64_t>(safe_ns, 1) : safe_ns);
    measure();
    return true;
  }

  // The hit lies where the bound fell a dip below the level; slow approaches were below it long before. Halve the way back to where the bound met
  // the level.
  Hit first_of_hit() {
    Hit hit{now_, apart_.clearance_m};
    now_ = from_;
    const GapBound bound(motion_from(a_, from_, hit.at, sense_), motion_from(b_, from_, hit.at, sense_), direction_);
    SimTime above = later(static_cast<std::int64_t>(bound.meets_s(level_m_, to_seconds(Duration{left_ns(hit.at)})) * 1e9));
    while (std::abs((hit.at - above).count()) > 1) {
      const SimTime middle = above + (hit.at - above) / 2;
      const double clearance_m = at_m(middle);
      if (clearance_m < level_m_) {
        hit = {middle, clearance_m};
      } else {
        above = middle;
      }
    }
    return hit;
  }

  static constexpr double kWorn = 0.5;

  const Piece& a_;
  const Piece& b_;
  SimTime now_, to_, from_;
  TimeSense sense_;
  double level_m_;
  EvaluationCount& count_;
  Separation apart_;
  Vec2 direction_;
  bool measured_ = false;
};

}  // namespace

std::optional<Hit> advance(const Piece& a, const Piece& b, SimTime from, SimTime to, double level_m, EvaluationCount& count) {
  return Walk(a, b, from, to, level_m, count).run();
}

}  // namespace fleetproof
