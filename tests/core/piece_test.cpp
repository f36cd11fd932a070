#include "core/motion/piece.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/geometry/rotation.hpp"
#include "tests/support/at_seconds.hpp"

namespace fleetproof::piece_test {
namespace {

const SimTime kLate = at_seconds(300.0);

Piece drive(const Curve& curve, const Footprint& footprint = {}) {
  Piece piece;
  piece.manner = Manner::Drive;
  piece.begin = kLate;
  piece.curve = &curve;
  piece.start = curve.pose_at(0.0);
  piece.footprint = footprint;
  piece.profile = MotionProfile(curve.length_m(), {});
  piece.end = piece.begin + piece.profile.duration();
  return piece;
}

Piece turn(double turn_rad) {
  Piece piece;
  piece.manner = Manner::Turn;
  piece.begin = kLate;
  piece.start = {{5.0, 6.0}, unit_vector(1.0)};
  piece.turn_rad = turn_rad;
  piece.profile = MotionProfile(std::abs(turn_rad), {0.8, 0.8, 0.8});
  piece.end = piece.begin + piece.profile.duration();
  return piece;
}

TEST(Piece, RestStaysForever) {
  const Pose pose{{1.0, 2.0}, Vec2::UnitY()};
  const Piece piece = rest_piece(EntityId{3U}, {2.0, 1.0}, pose, kLate);
  EXPECT_EQ(piece.entity, EntityId{3U});
  EXPECT_EQ(piece.manner, Manner::Rest);
  EXPECT_EQ(piece.end, kForever);
  EXPECT_EQ(piece.pose_at(kForever).position_m, pose.position_m);
  EXPECT_EQ(piece.speed_at(at_seconds(400.0)), 0.0);
  const Box box = piece.swept_box(kForever);
  EXPECT_DOUBLE_EQ(box.low_m.x(), 0.5);
  EXPECT_DOUBLE_EQ(box.high_m.y(), 3.0);
}

TEST(Piece, DriveFollowsItsCurveAndClampsAtBothEnds) {
  const Curve curve = Curve::straight({0, 0}, {10, 0});
  const Piece piece = drive(curve);
  EXPECT_EQ(piece.pose_at(kStart).position_m, Vec2(0, 0));
  EXPECT_DOUBLE_EQ(piece.pose_at(kLate + seconds(4.0)).position_m.x(), 4.0);
  EXPECT_DOUBLE_EQ(piece.pose_at(kLate + seconds(5.0)).position_m.x(), 6.0);
  EXPECT_DOUBLE_EQ(piece.speed_at(kLate + seconds(2.0)), 1.0);
  EXPECT_EQ(piece.pose_at(piece.end).position_m.x(), 10.0);
  EXPECT_EQ(piece.pose_at(kForever).position_m.x(), 10.0);
  EXPECT_NEAR(piece.pose_at(kLate + Duration{1}).position_m.x(), 0.25e-18, 1e-30);
}

TEST(Piece, CutShortItKeepsItsTrajectoryAndStaysWhereItEnded) {
  const Curve curve = Curve::straight({0, 0}, {10, 0});
  Piece piece = drive(curve);
  piece.end = kLate + seconds(4.0);
  EXPECT_DOUBLE_EQ(piece.pose_at(kLate + seconds(2.0)).position_m.x(), 1.0);
  EXPECT_DOUBLE_EQ(piece.pose_at(kLate + seconds(7.0)).position_m.x(), 4.0);
  EXPECT_DOUBLE_EQ(piece.speed_at(piece.end), 2.0);
  EXPECT_DOUBLE_EQ(piece.swept_box(kForever).high_m.x(), 4.8);
}

TEST(Piece, TurnsOnTheSpotToEitherSide) {
  for (const double angle : {2.0, -2.0, 0.1, -kPi}) {
    const Piece piece = turn(angle);
    EXPECT_EQ(piece.pose_at(kLate).heading, piece.start.heading);
    EXPECT_NEAR((piece.pose_at(piece.end).heading - unit_vector(1.0 + angle)).norm(), 0.0, 1e-14);
    const SimTime halfway = kLate + piece.profile.duration() / 2;
    EXPECT_NEAR((piece.pose_at(halfway).heading - unit_vector(1.0 + 0.5 * angle)).norm(), 0.0, 1e-9);
    EXPECT_EQ(piece.pose_at(halfway).position_m, piece.start.position_m);
    EXPECT_EQ(piece.speed_at(halfway), 0.0);
  }
}

// Sound: every body on the way lies in the box. Tight: the box exceeds theirs by less than half a metre.
void expect_swept(const Piece& piece, SimTime until, double slack_m) {
  const Box box = piece.swept_box(until);
  Box bodies;
  for (SimTime t = piece.begin; t <= std::min(until, piece.end); t += Duration{500'000}) bodies.add(piece.body_at(t));
  bodies.add(piece.body_at(std::min(until, piece.end)));
  EXPECT_LE(box.low_m.x(), bodies.low_m.x() + 1e-12);
  EXPECT_LE(box.low_m.y(), bodies.low_m.y() + 1e-12);
  EXPECT_GE(box.high_m.x(), bodies.high_m.x() - 1e-12);
  EXPECT_GE(box.high_m.y(), bodies.high_m.y() - 1e-12);
  EXPECT_LT((bodies.low_m - box.low_m).maxCoeff(), slack_m);
  EXPECT_LT((box.high_m - bodies.high_m).maxCoeff(), slack_m);
}

TEST(Piece, SweptBoxIsSoundAndTight) {
  for (const double radius_m : {1.5, 2.0, 4.0, 30.0}) {
    for (const double heading_rad : {0.0, 0.7, 2.0, -2.5}) {
      for (const double side : {1.0, -1.0}) {
        const Curve arc(
            {Arc{{{3.0, 4.0}, unit_vector(heading_rad)}, std::min(20.0, 1.9 * kPi * radius_m), side / radius_m}});
        const Piece piece = drive(arc, {1.8, 1.2});
        for (const double part : {0.0, 0.2, 0.6, 1.0, 2.0})
          expect_swept(piece, piece.begin + seconds(part * to_seconds(piece.profile.duration())), 0.05);
      }
    }
  }
  const Curve straight = Curve::straight({0, 0}, {5, 3}), bend = Curve::bezier({0, 0}, {4, 0}, {2, 5}, {6, 6});
  for (const Curve* curve : {&straight, &bend}) {
    const Piece piece = drive(*curve);
    for (const double part : {0.1, 0.5, 1.0})
      expect_swept(piece, piece.begin + seconds(part * to_seconds(piece.profile.duration())), 0.05);
  }
  expect_swept(turn(-kPi), kForever, 0.5);
}

}  // namespace
}  // namespace fleetproof::piece_test
