#pragma once

#include <array>
#include <vector>

#include "core/geometry/curve.hpp"

namespace fleetproof {

// A cubic Bezier as arcs that join without kinks and stay within `tolerance_m` of it. Both ends and the tangents there
// are exact. A Bezier that is a straight line becomes one; one without length becomes one arc without length. Where the
// Bezier itself has a kink (a cusp) or doubles back, the arcs turn as tightly as they must: always a finite chain, at
// most 2^13 arcs.
std::vector<Arc> biarc_chain(const std::array<Vec2, 4>& control_points_m, double tolerance_m);

}  // namespace fleetproof
