#pragma once

#include <vector>

#include "core/geometry/pose.hpp"

namespace fleetproof {

// A way of straight legs in the form of a segment: cubic Bezier pieces, with an arc at each corner.
struct RoundedWay {
  std::vector<Vec2> control_points_m;  // between its first and its last point. None: straight; else 2, 5, 8, ...
  double off_m = 0.0;                  // how far the arcs pass by their corners at most
};

// Each arc begins kCornerRounding_m before its corner, or in the middle of the leg if that is nearer, and ends as far
// behind it. So the way keeps inside the legs, and begins and ends along them. Where the way turns round by more than
// 168 degrees, no arc is wide enough, and the corner remains, which the check of a layout refuses.
RoundedWay round_corners(const std::vector<Vec2>& points_m);

}  // namespace fleetproof
