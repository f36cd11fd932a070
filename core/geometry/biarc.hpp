#pragma once

#include <array>
#include <vector>

#include "core/geometry/curve.hpp"

namespace fleetproof {

// A cubic Bezier curve as a chain of arcs. The arcs join without kinks and stay within `tolerance_m` of the curve. Both
// ends and the tangents there are exact. A straight Bezier curve becomes one straight arc. A curve without length
// becomes one arc without length. Where the curve has a cusp or turns back, the arcs are as tight as necessary. The
// chain is always finite, with at most 2^13 arcs.
std::vector<Arc> biarc_chain(const std::array<Vec2, 4>& control_points_m, double tolerance_m);

}  // namespace fleetproof
