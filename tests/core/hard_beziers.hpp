#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "core/geometry/curve.hpp"
#include "tests/oracle/point.hpp"

namespace fleetproof::test {

using ControlPoints = std::array<Vec2, 4>;

inline std::array<oracle::Point, 4> points(const ControlPoints& p) {
  std::array<oracle::Point, 4> all;
  for (std::size_t i = 0; i < 4; ++i) all[i] = {p[i].x(), p[i].y()};
  return all;
}

// Curves that stand still somewhere, turn back, or have no length.
inline std::vector<ControlPoints> hard_beziers() {
  const Vec2 o(0, 0);
  return {{o, Vec2(1, 1), Vec2(0, 1), Vec2(1, 0)},                  // a cusp
          {o, Vec2(3, 3), Vec2(-2, 3), Vec2(1, 0)},                 // a loop
          {o, o, Vec2(2, 1), Vec2(3, 3)},                           // first control point on the end
          {o, Vec2(2, 0), Vec2(3, 3), Vec2(3, 3)},                  // last one
          {o, o, Vec2(3, 3), Vec2(3, 3)},                           // both: a line
          {o, Vec2(-1, 0), Vec2(2, 0), Vec2(1, 0)},                 // straight, but doubling back
          {o, Vec2(1, 0), Vec2(0, 1), o},                           // closed
          {o, Vec2(3, 3), Vec2(-3, -3), o},                         // closed and straight
          {o, Vec2(1, 0), Vec2(1, 0), Vec2(0, 1e-6)},               // ends nearly together
          {o, Vec2(1e-11, 0), Vec2(0, 1e-11), Vec2(1e-11, 1e-11)},  // next to nothing
          {Vec2(7, 7), Vec2(7, 7), Vec2(7, 7), Vec2(7, 7)},         // nothing
          {o, Vec2(0, 1e-13), Vec2(1, 1e-13), Vec2(1, 0)}};
}

// The parts of a curve meet in place and heading, and it has these ends.
inline void expect_joined(const Curve& curve, const Vec2& from, const Vec2& to) {
  const auto parts = curve.parts();
  ASSERT_FALSE(parts.empty());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Pose start = parts[i].pose_at(0.0);
    ASSERT_TRUE(std::isfinite(parts[i].length_m()) && std::isfinite(parts[i].most().per_m));
    ASSERT_GE(parts[i].length_m(), 0.0);
    ASSERT_NEAR(start.heading.norm(), 1.0, 1e-12);
    if (i == 0) continue;
    const Pose end = parts[i - 1].pose_at(parts[i - 1].length_m());
    ASSERT_LT((end.position_m - start.position_m).norm(), 1e-9);
    ASSERT_LT((end.heading - start.heading).norm(), 1e-9) << "part " << i;
  }
  ASSERT_LT((curve.pose_at(0.0).position_m - from).norm(), 1e-12);
  ASSERT_LT((curve.pose_at(curve.length_m()).position_m - to).norm(), 1e-9);
}

}  // namespace fleetproof::test
