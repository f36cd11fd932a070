#pragma once

#include <vector>

#include "core/geometry/curve.hpp"
#include "core/motion/motion_profile.hpp"

namespace fleetproof {

// A part of a curve with one speed limit, and the speeds at its two ends.
struct Leg {
  double begin_m = 0.0, end_m = 0.0;  // along the curve
  double limit_mps = 0.0;
  EndSpeeds speeds;
};

// Writes the legs of a drive along `curve` from `from_m` to its end into `legs`. In a bend of radius R, the limit is
// sqrt(lateral * R), but at least 0.05 m/s; neighbouring arcs of a bend share the limit of the tightest arc.
// `lateral_mps2` 0: no such limit. An AGV that enters a bend too fast brakes in the bend as hard as it can.
void plan_legs(const Curve& curve, const MotionLimits& limits, double lateral_mps2, double from_m,
               const EndSpeeds& ends, std::vector<Leg>& legs);

// The leg of the earliest possible stop. If the way is too short, the leg ends at the end of the curve, still moving.
void plan_stop(const Curve& curve, const MotionLimits& limits, double from_m, double entry_mps, std::vector<Leg>& legs);

// The highest speed at which an AGV can pass the start of `curve`. The AGV then takes the bends of the curve as above
// and stands at its end.
double highest_entry_mps(const Curve& curve, const MotionLimits& limits, double lateral_mps2);

}  // namespace fleetproof
