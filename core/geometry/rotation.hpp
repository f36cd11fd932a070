#pragma once

#include "core/geometry/pose.hpp"

// Angles, computed with + - * / and sqrt only: the functions sin, cos and atan2 of libm differ in the last bit between
// CPUs. The absolute error is below 1e-15.
namespace fleetproof {

inline constexpr double kPi = 3.14159265358979323846;

// (cos, sin) of an angle, |angle| <= 1e4 rad.
Vec2 unit_vector(double angle_rad);

// The angle in (-pi, pi] that turns the unit vector `from` into `to`. Headings that are opposite within 1e-15 give +pi.
double angle_between(const Vec2& from, const Vec2& to);

// `v` rotated by the angle whose (cos, sin) is `rotation`.
inline Vec2 rotated(const Vec2& v, const Vec2& rotation) {
  return {v.x() * rotation.x() - v.y() * rotation.y(), v.x() * rotation.y() + v.y() * rotation.x()};
}

}  // namespace fleetproof
