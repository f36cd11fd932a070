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

// The control points of cubic pieces along the arc from the first to the last point that passes `via_m`; none if the
// three lie on one line. Each piece turns by at most 45 degrees, so that it is within 5e-6 radii of the circle.
std::vector<Vec2> arc_through(const Vec2& from_m, const Vec2& via_m, const Vec2& to_m);

// Whether all points lie on the line between the outermost ones, in this order.
bool is_straight(const std::vector<Vec2>& points_m);

}  // namespace fleetproof
