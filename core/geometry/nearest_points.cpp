#include "core/geometry/nearest_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/tolerances.hpp"

namespace fleetproof {
namespace {

std::array<Vec2, 4> corners(const OrientedRectangle& body) {
  const Vec2 along = body.half_length_m * body.heading, aside = body.half_width_m * left_of(body.heading);
  return {body.centre_m + along + aside, body.centre_m - along + aside, body.centre_m - along - aside,
          body.centre_m + along - aside};
}

Vec2 nearest_point_of(const OrientedRectangle& body, const Vec2& point_m) {
  const Vec2 offset = point_m - body.centre_m;
  const double along = std::clamp(offset.dot(body.heading), -body.half_length_m, body.half_length_m);
  const double aside = std::clamp(cross(body.heading, offset), -body.half_width_m, body.half_width_m);
  return body.centre_m + along * body.heading + aside * left_of(body.heading);
}

// Where the sides of the two rectangles cross. Parallel sides share corners, or nothing.
void add_crossings(const std::array<Vec2, 4>& first, const std::array<Vec2, 4>& second, std::vector<PointPair>& pairs) {
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec2 side = first[(i + 1) % 4] - first[i];
    for (std::size_t j = 0; j < 4; ++j) {
      const Vec2 other = second[(j + 1) % 4] - second[j], between = second[j] - first[i];
      const double sine = cross(side, other);
      if (std::abs(sine) <= kAlongSide * side.norm() * other.norm()) continue;
      const double here = cross(between, other) / sine, there = cross(between, side) / sine;
      if (here < 0.0 || here > 1.0 || there < 0.0 || there > 1.0) continue;
      const Vec2 at = first[i] + here * side;
      pairs.push_back({at, at});
    }
  }
}

}  // namespace

std::vector<PointPair> nearest_points(const OrientedRectangle& first, const OrientedRectangle& second) {
  const auto of_first = corners(first), of_second = corners(second);
  std::vector<PointPair> pairs;
  pairs.reserve(of_first.size() + of_second.size() + of_first.size() * of_second.size());
  double least_m = std::numeric_limits<double>::infinity();
  const auto offer = [&](const PointPair& pair) {
    pairs.push_back(pair);
    least_m = std::min(least_m, (pair.on_second - pair.on_first).norm());
  };
  for (const Vec2& corner : of_first) offer({corner, nearest_point_of(second, corner)});
  for (const Vec2& corner : of_second) offer({nearest_point_of(first, corner), corner});
  const bool overlap = clearance_m(first, second) <= 0.0;
  if (overlap) {
    add_crossings(of_first, of_second, pairs);
    least_m = 0.0;
  }
  std::vector<PointPair> nearest;
  std::ranges::copy_if(pairs, std::back_inserter(nearest), [&](const PointPair& pair) {
    return (pair.on_second - pair.on_first).norm() <= least_m + kEquallyNear_m;
  });
  return nearest;
}

}  // namespace fleetproof
