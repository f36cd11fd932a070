// Circular arcs, and chains of them in place of Bezier curves.
#pragma once

#include <array>
#include <vector>

#include "core/geometry/pose.hpp"

namespace fleetproof {

// A straight line (curvature 0) or a circular arc, from `start` along its heading. Positive curvature turns left.
struct Arc {
  Pose start;
  double length_m = 0.0;
  double curvature_per_m = 0.0;

  Pose pose_at(double s_m) const;
  // The same arc driven the other way.
  Arc reversed() const;
};

// How far a chain of arcs may be from its curve, and how far its heading from the heading of the curve there.
struct ArcTolerance {
  double position_m = 0.0, heading_rad = 0.0;
};

// A cubic Bezier curve as a chain of arcs. The arcs join without kinks and stay within `tolerance` of the curve. Both
// ends and the tangents there are exact. A straight Bezier curve becomes one straight arc. A curve without length
// becomes one arc without length. Where the curve has a cusp or turns back, the arcs are as tight as necessary. The
// chain is always finite, with at most 2^13 arcs.
std::vector<Arc> biarc_chain(const std::array<Vec2, 4>& control_points_m, const ArcTolerance& tolerance);

// True without length, or if both control points lie between the ends on the line through the ends. In any order, the
// curve then never turns back.
bool is_straight_bezier(const std::array<Vec2, 4>& control_points_m);

}  // namespace fleetproof
