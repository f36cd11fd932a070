#pragma once

#include <Eigen/Core>

namespace fleetproof {

// Points and directions on the warehouse floor, world frame, metres. Headings are unit vectors: no angle, no libm.
using Vec2 = Eigen::Vector2d;

struct Pose {
  Vec2 position_m = Vec2::Zero();
  Vec2 heading = Vec2::UnitX();
};

inline double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }
inline Vec2 left_of(const Vec2& v) { return {-v.y(), v.x()}; }

}  // namespace fleetproof
