#include "laws/middle_line.hpp"

#include <algorithm>

namespace fleetproof {

MiddleLine MiddleLine::of(const Curve& curve, const Footprint& footprint) {
  const Pose start = curve.pose_at(0.0);
  const double nose = curve.is_tail_first() ? -1.0 : 1.0;
  const Vec2 travel = nose * start.heading;
  const double first_m = nose * footprint.centre_ahead_m - 0.5 * footprint.length_m;
  return {start.position_m + first_m * travel, travel, curve.length_m() + footprint.length_m};
}

double MiddleLine::square_distance_m2(const Vec2& point_m) const {
  const Vec2 from_begin_m = point_m - begin_m;
  const double along_m = std::clamp(from_begin_m.dot(travel), 0.0, length_m);
  return (from_begin_m - along_m * travel).squaredNorm();
}

// Whether all of the other line is beyond an end of this one, or on one side of it.
bool MiddleLine::has_aside(const MiddleLine& other, double distance_m) const {
  const Vec2 first_m = other.begin_m - begin_m, last_m = other.end_m() - begin_m;
  const double along_1 = first_m.dot(travel), along_2 = last_m.dot(travel);
  if (std::min(along_1, along_2) > length_m + distance_m || std::max(along_1, along_2) < -distance_m) return true;
  const Vec2 left(-travel.y(), travel.x());
  const double aside_1 = first_m.dot(left), aside_2 = last_m.dot(left);
  return std::min(aside_1, aside_2) > distance_m || std::max(aside_1, aside_2) < -distance_m;
}

}  // namespace fleetproof
