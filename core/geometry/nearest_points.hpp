#pragma once

#include <vector>

#include "core/geometry/rectangle.hpp"

namespace fleetproof {

// A point of each of two bodies, both on the floor.
struct PointPair {
  Vec2 on_first, on_second;
};

// The points at which two rectangles are nearest. If a whole edge is nearest, both of its ends. If the rectangles
// overlap, the corners of what they share; both points of such a pair are the same. Never empty.
std::vector<PointPair> nearest_points(const OrientedRectangle& first, const OrientedRectangle& second);

}  // namespace fleetproof
