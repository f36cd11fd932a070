#include "core/motion/speed_plan.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/tolerances.hpp"

namespace fleetproof {
namespace {

constexpr double kSlowest_mps = 0.05;  // in the tightest of bends

double limit_on(const CurvePart& part, double speed_mps, double lateral_mps2) {
  if (lateral_mps2 == 0.0 || part.is_straight()) return speed_mps;
  return std::min(speed_mps, std::max(kSlowest_mps, std::sqrt(lateral_mps2 / part.most().per_m)));
}

// Cuts the curve where straight and bent parts meet.
void cut(const Curve& curve, double speed_mps, double lateral_mps2, double from_m, std::vector<Leg>& legs) {
  legs.clear();
  const auto ends = curve.ends_m();
  for (std::size_t i = 0; i < ends.size(); ++i) {
    if (ends[i] <= from_m && i + 1 < ends.size()) continue;
    const double limit = limit_on(curve.parts()[i], speed_mps, lateral_mps2);
    const bool joins = !legs.empty() && (limit < speed_mps) == (legs.back().limit_mps < speed_mps);
    if (joins) {
      legs.back().end_m = ends[i];
      legs.back().limit_mps = std::min(legs.back().limit_mps, limit);
    } else {
      legs.push_back({legs.empty() ? from_m : legs.back().end_m, ends[i], limit, {}});
    }
  }
}

// A stop is a stop: a speed that only rounding leaves becomes zero.
double after(double speed, double acceleration, double way) {
  const double squared = speed * speed + 2.0 * acceleration * way;
  return squared < kStands_m2ps2 + kStands * speed * speed ? 0.0 : std::sqrt(squared);
}

// Slow enough for everything behind: from the last leg back to the first.
void slow_down_in_time(const MotionLimits& limits, double exit_mps, std::vector<Leg>& legs) {
  double next = exit_mps;
  for (auto leg = legs.rbegin(); leg != legs.rend(); ++leg) {
    leg->speeds.exit_mps = std::min(next, leg->limit_mps);
    leg->speeds.entry_mps =
        std::min(leg->limit_mps, after(leg->speeds.exit_mps, limits.deceleration_mps2, leg->end_m - leg->begin_m));
    next = leg->speeds.entry_mps;
  }
}

}  // namespace

void plan_legs(const Curve& curve, const MotionLimits& limits, double lateral_mps2, double from_m,
               const EndSpeeds& ends, std::vector<Leg>& legs) {
  cut(curve, limits.speed_mps, lateral_mps2, from_m, legs);
  slow_down_in_time(limits, ends.exit_mps, legs);
  double speed = ends.entry_mps;
  for (Leg& leg : legs) {
    const double way = leg.end_m - leg.begin_m;
    const double slowest = after(speed, -limits.deceleration_mps2, way),
                 fastest = after(speed, limits.acceleration_mps2, way);
    leg.speeds.entry_mps = speed;
    leg.speeds.exit_mps = std::clamp(leg.speeds.exit_mps, slowest, fastest);
    leg.limit_mps = std::max({leg.limit_mps, leg.speeds.entry_mps, leg.speeds.exit_mps});
    speed = leg.speeds.exit_mps;
  }
}

void plan_stop(const Curve& curve, const MotionLimits& limits, double from_m, double entry_mps,
               std::vector<Leg>& legs) {
  const double rest_m = curve.length_m() - from_m, needed_m = entry_mps * entry_mps / (2.0 * limits.deceleration_mps2);
  const bool stops = needed_m <= rest_m + kBrakingRounding_m + kBrakingRounding * rest_m;
  const double exit_mps = stops ? 0.0 : after(entry_mps, -limits.deceleration_mps2, rest_m);
  legs.assign(1, {from_m,
                  stops ? std::min(from_m + needed_m, curve.length_m()) : curve.length_m(),
                  std::max(limits.speed_mps, entry_mps),
                  {entry_mps, exit_mps}});
}

double highest_entry_mps(const Curve& curve, const MotionLimits& limits, double lateral_mps2) {
  std::vector<Leg> legs;
  cut(curve, limits.speed_mps, lateral_mps2, 0.0, legs);
  slow_down_in_time(limits, 0.0, legs);
  return legs.empty() ? 0.0 : legs.front().speeds.entry_mps;
}

}  // namespace fleetproof
