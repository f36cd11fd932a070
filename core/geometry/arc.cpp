#include "core/geometry/arc.hpp"

#include "core/geometry/rotation.hpp"

namespace fleetproof {

Pose Arc::pose_at(double s_m) const {
  if (curvature_per_m == 0.0) return {start.position_m + s_m * start.heading, start.heading};
  // By the chord, which leaves the start at half the angle turned: exact also for a radius so large that 1 - cos would
  // cancel.
  const Vec2 half = unit_vector(0.5 * curvature_per_m * s_m);
  const Vec2 chord_heading = rotated(start.heading, half);
  return {start.position_m + (2.0 * half.y() / curvature_per_m) * chord_heading, rotated(chord_heading, half)};
}

Arc Arc::reversed() const {
  const Pose end = pose_at(length_m);
  return {{end.position_m, -end.heading}, length_m, -curvature_per_m};
}

}  // namespace fleetproof
