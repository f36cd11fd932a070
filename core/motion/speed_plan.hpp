#pragma once

#include <vector>

#include "core/geometry/curve.hpp"
#include "core/motion/motion_profile.hpp"

namespace fleetproof {

// A stretch of a curve driven under one speed limit, with the speeds at its two ends.
struct Leg {
  double begin_m = 0.0, end_m = 0.0;  // along the curve
  double limit_mps = 0.0;
  EndSpeeds speeds;
};

// The legs of a drive along `curve` from `from_m` to its end, into `legs`. In a curve of radius R no faster than
// sqrt(lateral * R); neighbouring curved arcs share the limit of the tightest. `lateral_mps2` 0: no such limit. Who
// enters a bend too fast brakes in it as hard as it can.
void plan_legs(const Curve& curve, const MotionLimits& limits, double lateral_mps2, double from_m,
               const EndSpeeds& ends, std::vector<Leg>& legs);

// The one leg of a stop as soon as possible. It ends at the end of the curve, still moving, if the way is too short.
void plan_stop(const Curve& curve, const MotionLimits& limits, double from_m, double entry_mps, std::vector<Leg>& legs);

// The highest speed at which the start of `curve` can be passed so that its bends are taken as above and its end is
// reached standing.
double highest_entry_mps(const Curve& curve, const MotionLimits& limits, double lateral_mps2);

}  // namespace fleetproof
