// Speeds of the closest points against closed forms.
#include <gtest/gtest.h>

#include "laws/exact_law.hpp"
#include "tests/laws/timeline.hpp"
#include "tests/support/at_seconds.hpp"

namespace fleetproof::test {
namespace {

constexpr double kHalfLength_m = 0.8, kHalfWidth_m = 0.5;  // of the default footprint
const double kCorner_m = std::sqrt(kHalfLength_m * kHalfLength_m + kHalfWidth_m * kHalfWidth_m);
const double kCornerAt_rad = std::atan2(kHalfWidth_m, kHalfLength_m);
constexpr double kTo_um = 1.01;  // 1e-6 m/s, and the rounding to whole micrometres

Violation only_violation(const Scene& scene) {
  const auto violations = play(scene, make_exact_law).violations;
  EXPECT_EQ(violations.size(), 1U);
  return violations.empty() ? Violation{} : violations[0];
}

double um(std::int64_t value_um) { return static_cast<double>(value_um); }

Piece announced(Piece piece, SimTime planned_end) {
  piece.end = planned_end;
  piece.planned_box =
      piece.swept_box(piece.manner == Manner::Drive ? piece.begin + piece.profile.duration() : kForever);
  return piece;
}

// A wall above the AGV: its lower side is at this height.
Scene beside_a_wall(double height_m) {
  Scene scene(4.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0));
  scene.obstacle(facing(0.0, height_m + 0.1, 1.0, 0.0), {8.0, 0.2});
  return scene;
}

TEST(RelativeSpeed, ACornerThatSwingsPastAWallMovesAlongIt) {
  Scene scene = beside_a_wall(kCorner_m + 0.05);
  scene.bodies[0].turn(1.7);  // at 1 rad/s from 0.5 rad to 1.2 rad
  const Violation violation = only_violation(scene);
  EXPECT_FALSE(violation.contact);
  EXPECT_NEAR(to_seconds(violation.closest_at), 1.0 + (kPi / 2.0 - kCornerAt_rad - 0.5), 1e-8);
  EXPECT_NEAR(um(violation.relative_speed_um_s), 1e6 * kCorner_m, kTo_um);
  EXPECT_NEAR(um(violation.normal_speed_um_s), 0.0, kTo_um);
  EXPECT_NEAR(um(violation.min_clearance_um), 50'000.0, 1.0);
}

TEST(RelativeSpeed, ACornerThatSwingsIntoAWallIsHazardousAlthoughTheAgvStandsOnItsPlace) {
  const double height_m = 0.8, angle_rad = std::asin((height_m - 0.5e-6) / kCorner_m) - kCornerAt_rad;
  const double touch_s = std::sqrt(2.0 * angle_rad);  // at 1 rad/s2: the rate in rad/s is the same number
  ASSERT_LT(touch_s, 1.0);
  Scene scene = beside_a_wall(height_m);
  scene.bodies[0].turn(2.0).cut_short_at(touch_s);
  const Violation violation = only_violation(scene);
  EXPECT_TRUE(violation.contact);
  EXPECT_EQ(violation.min_clearance_um, 0);
  EXPECT_NEAR(um(violation.relative_speed_um_s), 1e6 * touch_s * kCorner_m, kTo_um);
  EXPECT_NEAR(um(violation.normal_speed_um_s), 1e6 * touch_s * kCorner_m * std::cos(angle_rad + kCornerAt_rad), kTo_um);
  EXPECT_EQ(level_of(violation), ViolationLevel::HazardousContact);
}

TEST(RelativeSpeed, TheOuterCornerOfABoxOnAnArcIsFasterThanItsMiddle) {
  constexpr double kRadius_m = 2.0;
  const double outer_m = std::hypot(kRadius_m + kHalfWidth_m, kHalfLength_m);  // from the centre of the arc
  const double turned_rad = std::atan2(kRadius_m + kHalfWidth_m, kHalfLength_m);
  Scene scene(8.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(Curve({Arc{{}, 1.5 * kRadius_m, 1.0 / kRadius_m}}), {2.0, 0.5, 10.0});
  scene.obstacle(facing(outer_m + 0.05 + 0.1, kRadius_m, 1.0, 0.0), {0.2, 4.0});
  const Violation violation = only_violation(scene);
  const double speed_mps = std::sqrt(2.0 * 0.5 * turned_rad * kRadius_m);  // still gaining speed
  ASSERT_LT(speed_mps, 2.0);
  EXPECT_NEAR(to_seconds(violation.closest_at), speed_mps / 0.5, 1e-7);
  EXPECT_NEAR(um(violation.relative_speed_um_s), 1e6 * speed_mps * outer_m / kRadius_m, kTo_um);
  EXPECT_NEAR(um(violation.normal_speed_um_s), 0.0, kTo_um);
}

// Past a long box, side by side at 5 cm: the least clearance lasts from its near end to its far end.
TEST(RelativeSpeed, OfAFlatMinimumTheFirstInstantAndTheHighestSpeedCount) {
  Scene scene(10.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(12.0);
  scene.obstacle(facing(6.0, 1.05, 1.0, 0.0), {4.0, 1.0});
  const Violation violation = only_violation(scene);
  EXPECT_NEAR(to_seconds(violation.closest_at), std::sqrt(2.0 * 3.2 / 0.5), 1e-7);  // the nose has 3.2 m to the box
  EXPECT_NEAR(um(violation.relative_speed_um_s), 2e6, kTo_um) << "reached after 4 m, beside the box";
  EXPECT_NEAR(um(violation.normal_speed_um_s), 0.0, kTo_um);
}

// A flat minimum that a seam of pieces divides: the same, though the other piece is the faster one.
TEST(RelativeSpeed, AFlatMinimumGoesOnAcrossSeams) {
  Scene scene(20.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).wait_until(3.0).drive(1.0).wait_until(9.0).drive(8.0);
  scene.obstacle(facing(4.0, 1.05, 1.0, 0.0), {20.0, 1.0});
  const Violation violation = only_violation(scene);
  EXPECT_EQ(violation.closest_at, kStart);
  EXPECT_NEAR(um(violation.relative_speed_um_s), 2e6, kTo_um);
}

// If nothing stops the AGV, it goes on gaining speed inside the obstacle.
TEST(RelativeSpeed, TheHighestSpeedDuringAContactCounts) {
  Scene scene(10.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(12.0);
  scene.obstacle(facing(3.8, 0.0, 1.0, 0.0), {4.0, 1.0});  // touched after 1 m, left after 6.6 m
  const Violation violation = only_violation(scene);
  EXPECT_TRUE(violation.contact);
  EXPECT_NEAR(to_seconds(violation.closest_at), 2.0, 1e-5);
  EXPECT_NEAR(um(violation.relative_speed_um_s), 2e6, kTo_um);
  EXPECT_EQ(violation.min_clearance_um, 0);
}

// An obstacle appears where the AGV is, and the world stops it at once.
TEST(RelativeSpeed, IsThatOfTheAgvIfAnObstacleAppearsOnIt) {
  Scene scene(10.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(12.0).cut_short_at(3.0);
  scene.obstacle(facing(2.25, 0.0, 1.0, 0.0));
  const auto pieces = scene.bodies[0].until(scene.end);
  const auto law = make_exact_law(scene.scenario);
  law->piece_started(announced(pieces[0], kForever));
  Piece obstacle = announced(rest_piece(EntityId{1U}, {}, scene.bodies[1].pose(), at_seconds(3.0)), kForever);
  law->piece_started(obstacle);
  law->piece_ended(pieces[0]);
  law->piece_started(announced(pieces[1], kForever));
  obstacle.end = scene.end;
  law->piece_ended(obstacle);
  law->piece_ended(pieces[1]);
  law->finish(scene.end);
  const auto violations = law->findings().violations;
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_TRUE(violations[0].contact);
  EXPECT_NEAR(um(violations[0].relative_speed_um_s), 1.5e6, kTo_um);
}

}  // namespace
}  // namespace fleetproof::test
