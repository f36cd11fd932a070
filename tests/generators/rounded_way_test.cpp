#include "generators/formats/rounded_way.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/tolerances.hpp"
#include "core/scenario/layout.hpp"
#include "generators/map/layout_check.hpp"

namespace fleetproof::rounded_way_test {
namespace {

Segment segment_along(const std::vector<Vec2>& points_m) {
  Segment segment;
  segment.name = "ab";
  segment.from = StationId{std::size_t{0}};
  segment.to = StationId{std::size_t{1}};
  segment.control_points_m = round_corners(points_m).control_points_m;
  return segment;
}

Layout between(const std::vector<Vec2>& points_m) {
  Layout layout;
  layout.stations = {{"a", points_m.front(), Purpose::Routing}, {"b", points_m.back(), Purpose::Routing}};
  return layout;
}

Curve curve_along(const std::vector<Vec2>& points_m) {
  const auto layout = between(points_m);
  return segment_curve(layout, segment_along(points_m));
}

double distance_to_leg_m(const Vec2& a, const Vec2& b, const Vec2& point_m) {
  const double share = std::clamp((point_m - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (point_m - a - (b - a) * share).norm();
}

// Of a right angle: a quarter circle with a radius of half a metre.
TEST(RoundedWay, ARightAngleIsAQuarterCircle) {
  const std::vector<Vec2> points_m = {{0, 0}, {10, 0}, {10, 10}};
  const auto curve = curve_along(points_m);
  const double quarter_m = kCornerRounding_m * std::numbers::pi / 2.0;
  EXPECT_NEAR(curve.length_m(), 2.0 * (10.0 - kCornerRounding_m) + quarter_m, 1e-3);
  const Vec2 middle_m(10.0 - kCornerRounding_m, kCornerRounding_m);
  for (int i = 0; i <= 100; ++i) {
    const Vec2 at_m = curve.pose_at(10.0 - kCornerRounding_m + quarter_m * i / 100.0).position_m;
    EXPECT_NEAR((at_m - middle_m).norm(), kCornerRounding_m, 2e-4) << i;
  }
  EXPECT_NEAR(round_corners(points_m).off_m, kCornerRounding_m * (std::numbers::sqrt2 - 1.0), 2e-4);
}

// Legs of all lengths and corners of all angles below the sharpest.
TEST(RoundedWay, NeverLeavesTheLegsByMoreThanItSaysAndEndsAlongThem) {
  for (const double leg_m : {0.3, 1.0, 7.0}) {
    for (int degrees = -165; degrees <= 165; degrees += 15) {
      const double rad = degrees * std::numbers::pi / 180.0;
      const Vec2 corner_m(2.0, 0.0), end_m = corner_m + leg_m * Vec2(std::cos(rad), std::sin(rad));
      const std::vector<Vec2> points_m = {{0, 0}, corner_m, end_m};
      const auto curve = curve_along(points_m);
      double farthest_m = 0.0, nearest_m = 1e9;
      for (int i = 0; i <= 500; ++i) {
        const Vec2 at_m = curve.pose_at(curve.length_m() * i / 500.0).position_m;
        farthest_m = std::max(
            farthest_m, std::min(distance_to_leg_m({0, 0}, corner_m, at_m), distance_to_leg_m(corner_m, end_m, at_m)));
        nearest_m = std::min(nearest_m, (at_m - corner_m).norm());
      }
      const double off_m = round_corners(points_m).off_m;
      EXPECT_LE(farthest_m, off_m + 1e-6) << leg_m << " " << degrees;
      EXPECT_NEAR(nearest_m, off_m, 0.02) << leg_m << " " << degrees;
      EXPECT_LT((curve.pose_at(0.0).heading - Vec2(1, 0)).norm(), 1e-9);
      EXPECT_LT((curve.pose_at(curve.length_m()).heading - (end_m - corner_m).normalized()).norm(), 1e-6);
      EXPECT_LT(largest_kink_rad(segment_along(points_m)), kKink_rad) << leg_m << " " << degrees;
    }
  }
}

TEST(RoundedWay, ThereAndBackAreOneTrack) {
  const std::vector<Vec2> there_m = {{0, 0}, {3, 0.2}, {3.5, 2}, {9, 2}}, back_m(there_m.rbegin(), there_m.rend());
  const auto there = round_corners(there_m).control_points_m, back = round_corners(back_m).control_points_m;
  ASSERT_EQ(there.size(), back.size());
  for (std::size_t i = 0; i < there.size(); ++i) EXPECT_LT((there[i] - back[back.size() - 1 - i]).norm(), 1e-9);
}

// A circle of 2 m radius, drawn as 200 short legs.
TEST(RoundedWay, ManyShortLegsMakeTheCurveThatTheyWereTakenFrom) {
  std::vector<Vec2> points_m;
  for (int i = 0; i <= 200; ++i) points_m.emplace_back(2.0 * std::cos(i * 0.02), 2.0 * std::sin(i * 0.02));
  const auto curve = curve_along(points_m);
  for (int i = 0; i <= 1'000; ++i)
    EXPECT_NEAR(curve.pose_at(curve.length_m() * i / 1'000.0).position_m.norm(), 2.0, 2e-4) << i;
  EXPECT_LT(round_corners(points_m).off_m, 2e-4);
}

TEST(RoundedWay, StraightWaysHaveNoControlPoints) {
  EXPECT_TRUE(round_corners({{0, 0}, {4, 0}}).control_points_m.empty());
  EXPECT_TRUE(round_corners({{0, 0}, {1, 1}, {1, 1}, {3, 3}}).control_points_m.empty());
}

TEST(RoundedWay, ACornerAtWhichTheWayTurnsRoundRemains) {
  const auto way = round_corners({{0, 0}, {10, 0}, {5, 0.01}});
  EXPECT_EQ(way.off_m, 0.0);
  ASSERT_EQ(way.control_points_m.size(), 5U);
  EXPECT_EQ(way.control_points_m[2], Vec2(10, 0));
}

}  // namespace
}  // namespace fleetproof::rounded_way_test
