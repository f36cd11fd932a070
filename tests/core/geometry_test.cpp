#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/geometry/curve.hpp"
#include "core/geometry/rotation.hpp"
#include "tests/oracle/rectangle_check.hpp"

namespace fleetproof::geometry_test {
namespace {

using namespace test;

// Depth of an overlap: the nearest edge of the hull of all differences of corners, seen from the origin.
long double depth_oracle_m(const OrientedRectangle& first, const OrientedRectangle& second) {
  std::array<LongPoint, 16> d;
  for (std::size_t i = 0; i < 16; ++i) {
    const LongPoint p = corners_of(first)[i / 4], q = corners_of(second)[i % 4];
    d[i] = {q.x - p.x, q.y - p.y};
  }
  long double depth = 1e30L;
  for (const LongPoint& p : d) {
    for (const LongPoint& q : d) {
      const long double length = std::hypot(q.x - p.x, q.y - p.y);
      if (length < 1e-9L) continue;
      const bool hull = std::all_of(d.begin(), d.end(), [&](const LongPoint& r) { return area(p, q, r) > -1e-12L; });
      if (hull) depth = std::min(depth, area(p, q, {0, 0}) / length);
    }
  }
  return depth;
}

TEST(Rectangle, SeparationAgreesWithLongDoubleOracleAnywhere) {
  Random random;
  int apart = 0;
  for (int i = 0; i < 50'000; ++i) {
    const double range_m = i % 2 == 0 ? 5.0 : 15.0;
    const OrientedRectangle a = random.anywhere(range_m), b = random.anywhere(range_m);
    apart += clearance_m(a, b) > 0.0;
    ASSERT_NO_FATAL_FAILURE(check_pair(a, b)) << i;
  }
  EXPECT_GT(apart, 10'000);
  EXPECT_LT(apart, 49'000);
}

TEST(Rectangle, SeparationAgreesWithLongDoubleOracleOnALattice) {
  Random random;
  int touching = 0;
  for (int i = 0; i < 30'000; ++i) {
    const OrientedRectangle a = random.on_lattice(), b = random.on_lattice();
    touching += std::abs(clearance_m(a, b)) < 1e-12;
    ASSERT_NO_FATAL_FAILURE(check_pair(a, b)) << i;
  }
  EXPECT_GT(touching, 100);
}

TEST(Rectangle, ParallelAndTouchingPairsKeepTheirGap) {
  Random random;
  for (int i = 0; i < 20'000; ++i) {
    const double gap_m = i % 4 == 0 ? 0.0 : i % 4 == 1 ? 1e-9 : 0.10;
    const auto [a, b] = random.beside(500.0, gap_m);
    ASSERT_NO_FATAL_FAILURE(check_pair(a, b)) << i;
    ASSERT_NEAR(separation(a, b).clearance_m, gap_m, 1e-12);
    ASSERT_NEAR((separation(a, b).direction - left_of(a.heading)).norm(), 0.0, gap_m < 1e-6 ? 2e-3 : 1e-9);
  }
}

TEST(Rectangle, DepthIsThatOfTheShallowestWayOut) {
  Random random;
  int overlaps = 0;
  for (int i = 0; i < 4'000; ++i) {
    const OrientedRectangle a = random.anywhere(2.0), b = random.anywhere(2.0);
    const double clearance = clearance_m(a, b);
    if (clearance > 0.0) continue;
    ++overlaps;
    ASSERT_NEAR(-clearance, static_cast<double>(depth_oracle_m(a, b)), 1e-11);
    const Separation apart = separation(a, b);
    OrientedRectangle moved = b;
    moved.centre_m += (1e-6 - clearance) * apart.direction;
    ASSERT_NEAR(clearance_m(a, moved), 1e-6, 1e-11);
  }
  EXPECT_GT(overlaps, 1'000);
}

TEST(Rectangle, CornersRunCounterClockwiseFromFrontLeft) {
  const OrientedRectangle r = placed({2.0, 1.0}, {{10.0, 20.0}, Vec2::UnitY()});
  const std::array<Vec2, 4> expected{Vec2(9.5, 21.0), Vec2(9.5, 19.0), Vec2(10.5, 19.0), Vec2(10.5, 21.0)};
  for (int i = 0; i < 4; ++i) EXPECT_NEAR((corner_of(r, i) - expected[static_cast<std::size_t>(i)]).norm(), 0.0, 1e-15);
  EXPECT_DOUBLE_EQ((Footprint{1.6, 1.2}).reach_m(), 1.0);
  EXPECT_DOUBLE_EQ(clearance_m(widened(r, 0.25), placed({1.0, 1.0}, {{12.0, 20.0}, Vec2::UnitX()})), 0.75);
}

TEST(Rectangle, BoxHoldsAllCornersAndNoMore) {
  Random random;
  for (int i = 0; i < 1'000; ++i) {
    const OrientedRectangle r = random.anywhere(10.0);
    Box box, corners;
    box.add(r);
    for (int k = 0; k < 4; ++k) corners.add(corner_of(r, k));
    ASSERT_NEAR((box.low_m - corners.low_m).norm() + (box.high_m - corners.high_m).norm(), 0.0, 1e-14);
  }
}

TEST(Rotation, UnitVectorAgreesWithLibm) {
  Random random;
  double worst = 0.0;
  const auto check = [&](double angle) {
    const Vec2 v = unit_vector(angle);
    const long double exact = angle;
    worst = std::max({worst, std::abs(static_cast<double>(v.x() - std::cos(exact))),
                      std::abs(static_cast<double>(v.y() - std::sin(exact)))});
  };
  for (int i = 0; i < 200'000; ++i) check(random.in(-1.0, 1.0) * (i % 2 == 0 ? 7.0 : 1e4));
  for (int k = -6'000; k <= 6'000; ++k) check(k * 0.25 * kPi);
  EXPECT_LT(worst, 1e-15);
  EXPECT_EQ(unit_vector(0.0), Vec2(1.0, 0.0));
}

TEST(Rotation, AngleBetweenAgreesWithLibm) {
  Random random;
  double worst = 0.0;
  for (int i = 0; i < 200'000; ++i) {
    const double small = i % 3 == 0 ? 1e-6 : 1.0;
    const Vec2 from = unit_vector(random.in(-kPi, kPi)), to = rotated(from, unit_vector(small * random.in(-kPi, kPi)));
    const long double fx = from.x(), fy = from.y(), tx = to.x(), ty = to.y();
    worst = std::max(worst, std::abs(static_cast<double>(angle_between(from, to) -
                                                         std::atan2(fx * ty - fy * tx, fx * tx + fy * ty))));
  }
  EXPECT_LT(worst, 1e-15);
}

TEST(Rotation, OppositeHeadingsTurnLeft) {
  Random random;
  for (int i = 0; i < 1'000; ++i) {
    const Vec2 heading = unit_vector(random.in(-kPi, kPi));
    ASSERT_EQ(angle_between(heading, -heading), kPi);
    ASSERT_EQ(angle_between(heading, heading), 0.0);
    const Vec2 nearly = rotated(heading, unit_vector(kPi));
    ASSERT_EQ(angle_between(heading, nearly), kPi);
  }
  EXPECT_DOUBLE_EQ(angle_between(Vec2::UnitX(), Vec2::UnitY()), 0.5 * kPi);
  EXPECT_DOUBLE_EQ(angle_between(Vec2::UnitY(), Vec2::UnitX()), -0.5 * kPi);
}

}  // namespace
}  // namespace fleetproof::geometry_test
