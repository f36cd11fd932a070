// Speeds of the closest points against closed forms.
#include <gtest/gtest.h>

#include "laws/exact_law.hpp"
#include "tests/laws/timeline.hpp"
#include "tests/support/at_seconds.hpp"

namespace fleetproof::test::relative_speed_test {
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

constexpr double kTouched_m = 1e-6;  // a contact begins at this clearance

// The front left corner of an AGV that turns about the origin.
struct SwungCorner {
  double angle_rad = 0.0, rate_rad_s = 0.0;  // of the AGV

  Vec2 velocity_mps() const {
    const double at_rad = angle_rad + kCornerAt_rad;
    return rate_rad_s * kCorner_m * Vec2(-std::sin(at_rad), std::cos(at_rad));
  }
};

// The corner meets the lower side of an AGV that drives by above it, along the x axis.
TEST(RelativeSpeed, ACornerThatSwingsIntoADrivingAgvAtSeveralRates) {
  const double height_m = 0.85;
  for (const double rate_rad_s : {0.4, 0.7, 1.1}) {
    for (const double driven_mps : {-1.2, 0.5, 1.5}) {
      Scene scene(12.0);
      // At full rate at once, up to rounding: the ramps last a microsecond.
      const double touch_rad = std::asin((height_m - kTouched_m) / kCorner_m) - kCornerAt_rad;
      const double touch_s = touch_rad / rate_rad_s;
      scene.agv(facing(0.0, 0.0, 1.0, 0.0)).turn(2.0, {rate_rad_s, 1e6, 1e6}).cut_short_at(touch_s + 1e-6);
      const double heading = driven_mps < 0.0 ? -1.0 : 1.0, speed = std::abs(driven_mps);
      scene.agv(facing(-heading * speed * touch_s, height_m + kHalfWidth_m, heading, 0.0))
          .drive(20.0, {speed, 1e6, 1e6})
          .cut_short_at(touch_s + 1e-6);
      const Violation violation = only_violation(scene);
      EXPECT_TRUE(violation.contact);
      const Vec2 closing = SwungCorner{touch_rad, rate_rad_s}.velocity_mps() - Vec2(driven_mps, 0.0);
      EXPECT_NEAR(um(violation.relative_speed_um_s), 1e6 * closing.norm(), kTo_um) << rate_rad_s << " " << driven_mps;
      EXPECT_NEAR(um(violation.normal_speed_um_s), 1e6 * closing.y(), kTo_um) << rate_rad_s << " " << driven_mps;
    }
  }
}

// The turn slows down while the corner goes on: at the touch, its rate is sqrt(2 d x), x being the angle that is left.
TEST(RelativeSpeed, ACornerOfATurnThatSlowsDown) {
  for (const double slowing_rad_s2 : {0.2, 0.5, 2.0}) {
    const double height_m = 0.75, touch_rad = std::asin((height_m - kTouched_m) / kCorner_m) - kCornerAt_rad;
    const double left_rad = 0.05, rate_rad_s = std::sqrt(2.0 * slowing_rad_s2 * left_rad);
    Scene scene = beside_a_wall(height_m);
    scene.bodies[0].turn(touch_rad + left_rad, {5.0, 8.0, slowing_rad_s2});
    const auto pieces = scene.bodies[0].until(scene.end);
    const double end_s = to_seconds(pieces[0].end) - rate_rad_s / slowing_rad_s2;
    scene.bodies[0].cut_short_at(end_s + 1e-8);
    const Violation violation = only_violation(scene);
    EXPECT_TRUE(violation.contact);
    const Vec2 corner_mps = SwungCorner{touch_rad, rate_rad_s}.velocity_mps();
    EXPECT_NEAR(um(violation.relative_speed_um_s), 1e6 * corner_mps.norm(), kTo_um) << slowing_rad_s2;
    EXPECT_NEAR(um(violation.normal_speed_um_s), 1e6 * corner_mps.y(), kTo_um) << slowing_rad_s2;
  }
}

// The outer front corner of an AGV on an arc about the origin hits a wall that stands across its circle: its speed is
// that of the middle times its distance from the centre, and it leads square to the line to the centre.
TEST(RelativeSpeed, TheCornerOfABoxOnAnArcHitsAWall) {
  for (const double radius_m : {1.2, 2.5}) {
    for (const double slowing_mps2 : {0.0, 0.6}) {
      const double corner_m = std::hypot(radius_m + kHalfWidth_m, kHalfLength_m),
                   corner_rad = std::atan2(kHalfLength_m, radius_m + kHalfWidth_m), touch_rad = 0.9;
      const double speed_mps = 1.1, wall_y_m = corner_m * std::sin(corner_rad + touch_rad) + kTouched_m;
      // Driven on the arc up to the touch, at a constant speed or slowing down from a speed to this one.
      const double way_m = touch_rad * radius_m;
      const double left_m = slowing_mps2 > 0.0 ? speed_mps * speed_mps / (2.0 * slowing_mps2) : 1.0;
      const MotionLimits limits{slowing_mps2 > 0.0 ? 3.0 : speed_mps, slowing_mps2 > 0.0 ? 40.0 : 1e6,
                                slowing_mps2 > 0.0 ? slowing_mps2 : 1e6};
      const Pose start = facing(radius_m, 0.0, 0.0, 1.0);
      Scene scene(12.0);
      scene.agv(start).drive(Curve({Arc{start, way_m + left_m, 1.0 / radius_m}}), limits);
      scene.obstacle(facing(0.0, wall_y_m + 0.1, 1.0, 0.0), {30.0, 0.2});
      const auto pieces = scene.bodies[0].until(scene.end);
      const double touch_s =
          slowing_mps2 > 0.0 ? to_seconds(pieces[0].end) - speed_mps / slowing_mps2 : pieces[0].profile.time_at(way_m);
      scene.bodies[0].cut_short_at(touch_s + 1e-8);
      const Violation violation = only_violation(scene);
      EXPECT_TRUE(violation.contact);
      const double of_corner_mps = speed_mps * corner_m / radius_m;
      EXPECT_NEAR(um(violation.relative_speed_um_s), 1e6 * of_corner_mps, kTo_um) << radius_m << " " << slowing_mps2;
      EXPECT_NEAR(um(violation.normal_speed_um_s), 1e6 * of_corner_mps * std::cos(corner_rad + touch_rad), 2.0)
          << radius_m << " " << slowing_mps2;
    }
  }
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
  Piece drives = announced(pieces[0], kForever), stands = announced(pieces[1], kForever);
  Teller teller(*law, scene.bodies.size());
  teller.begins(drives);
  Piece obstacle = announced(rest_piece(EntityId{1U}, {}, scene.bodies[1].pose(), at_seconds(3.0)), kForever);
  teller.begins(obstacle);
  drives.end = pieces[0].end;
  teller.ends(drives);
  teller.begins(stands);
  obstacle.end = stands.end = scene.end;
  teller.ends(obstacle);
  teller.ends(stands);
  law->finish(scene.end);
  const auto violations = law->findings().violations;
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_TRUE(violations[0].contact);
  EXPECT_NEAR(um(violations[0].relative_speed_um_s), 1.5e6, kTo_um);
}

// A load makes a resting AGV wider where another one passes; the world stops that at once. `number`: of the resting
// one.
Violation growth_into(Scene& scene, const Piece& stops, const Piece& moves, std::uint32_t number) {
  const auto law = make_exact_law(scene.scenario);
  const SimTime at = moves.end;
  Piece narrow = announced(rest_piece(EntityId{number}, {}, scene.bodies[number].pose(), kStart), kForever);
  Piece wide = announced(rest_piece(EntityId{number}, {1.6, 1.6}, scene.bodies[number].pose(), at), kForever);
  Piece passes = announced(moves, kForever), stands = announced(stops, kForever);
  Teller teller(*law, scene.bodies.size());
  teller.begins(narrow);
  teller.begins(passes);
  narrow.end = at;
  teller.ends(narrow);
  teller.begins(wide);
  passes.end = at;
  teller.ends(passes);
  teller.begins(stands);
  wide.end = stands.end = scene.end;
  teller.ends(wide);
  teller.ends(stands);
  law->finish(scene.end);
  const auto violations = law->findings().violations;
  EXPECT_EQ(violations.size(), 1U);
  return violations.empty() ? Violation{} : violations[0];
}

TEST(RelativeSpeed, IsThatOfTheOneThatPassesIfALoadGrowsIntoIt) {
  for (const std::uint32_t resting : {0U, 1U}) {  // whichever is named first
    Scene scene(10.0);
    if (resting == 0) scene.agv(facing(5.0, 1.2, 1.0, 0.0));
    scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(12.0).cut_short_at(4.0);  // at 4 m, with 2 m/s
    if (resting == 1) scene.agv(facing(5.0, 1.2, 1.0, 0.0));
    const auto pieces = scene.bodies[1 - resting].until(scene.end);
    const Violation violation = growth_into(scene, pieces[1], pieces[0], resting);
    EXPECT_TRUE(violation.contact);
    EXPECT_EQ(violation.first, at_seconds(4.0));
    EXPECT_EQ(level_of(violation), ViolationLevel::HazardousContact);
    EXPECT_NEAR(um(violation.relative_speed_um_s), 2e6, kTo_um);
  }
}

// A corner at 1 rad/s.
TEST(RelativeSpeed, IsThatOfTheOneThatTurnsIfALoadGrowsIntoIt) {
  Scene scene(10.0);
  scene.agv(facing(0.0, 1.5, 1.0, 0.0));
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).turn(1.7).cut_short_at(1.0);  // 0.5 rad
  const auto pieces = scene.bodies[1].until(scene.end);
  const Violation violation = growth_into(scene, pieces[1], pieces[0], 0);
  EXPECT_TRUE(violation.contact);
  EXPECT_GT(violation.relative_speed_um_s, 300'000);
}

// One that only grows again, or that was there before, adds nothing.
TEST(RelativeSpeed, IsNoneIfALoadGrowsIntoOneThatStands) {
  Scene scene(10.0);
  scene.agv(facing(0.0, 1.2, 1.0, 0.0));
  scene.agv(facing(0.0, 0.0, 1.0, 0.0));
  Piece before = scene.bodies[1].until(scene.end)[0], after = before;
  before.end = after.begin = at_seconds(2.0);
  const Violation violation = growth_into(scene, after, before, 0);
  EXPECT_TRUE(violation.contact);
  EXPECT_EQ(violation.relative_speed_um_s, 0);
}

}  // namespace
}  // namespace fleetproof::test::relative_speed_test
