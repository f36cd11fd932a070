#pragma once

#include <vector>

#include "core/motion/piece.hpp"

namespace fleetproof {

// Convex, anticlockwise.
using Polygon = std::vector<Vec2>;

// The hull of an activity (Sect. 3.3): all that a body covers while a piece lasts, as polygons that follow each other.
// That of a rest or of a straight drive is exact. Of a turn or a bend, each polygon wraps two poses and lies within
// kHullSlack_m of what the body covers.
struct Hull {
  std::vector<Polygon> parts;
  Box box;
};
inline constexpr double kHullSlack_m = 1e-3;

Hull hull_of(const Piece& piece);
Hull hull_of(const OrientedRectangle& body);

// Whether less than `distance_m` is between the two.
bool are_within(const Hull& one, const Hull& other, double distance_m);

}  // namespace fleetproof
