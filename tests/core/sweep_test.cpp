#include "core/clearance/sweep.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>
#include <vector>

#include "core/base/random.hpp"
#include "core/base/tolerances.hpp"
#include "core/geometry/rotation.hpp"

namespace fleetproof::sweep_test {
namespace {

constexpr double kNear_m = 1e-5;
constexpr int kPoses = 250;  // of each motion

// A sweep beside the poses of its body, and how far a point of the body moves from one pose to the next.
struct Sampled {
  explicit Sampled(const Footprint& of) : footprint(of), sweep(of) {}

  void turn(const Pose& pose, double turn_rad) {
    sweep.add_turn(pose, turn_rad);
    for (int i = 0; i <= kPoses; ++i) at({pose.position_m, rotated(pose.heading, unit_vector(turn_rad * i / kPoses))});
    step_m = std::max(step_m, std::abs(turn_rad) / kPoses * footprint.reach_m());
  }
  void drive(const Curve& along) {
    const Curve& curve = curves.emplace_back(along);
    sweep.add_drive(curve);
    double most_per_m = 0.0;
    for (const CurvePart& part : curve.parts()) most_per_m = std::max(most_per_m, part.most().per_m);
    for (int i = 0; i <= kPoses; ++i) at(curve.pose_at(curve.length_m() * i / kPoses));
    step_m = std::max(step_m, curve.length_m() / kPoses * (1.0 + most_per_m * footprint.reach_m()));
  }
  void at(const Pose& pose) { bodies.push_back(placed(footprint, pose)); }

  Footprint footprint;
  Sweep sweep;
  std::deque<Curve> curves;  // they stay where they are
  std::vector<OrientedRectangle> bodies;
  double step_m = 0.0;
};

double least_clearance_m(const Sampled& a, const Sampled& b) {
  double least_m = 1e9;
  for (const OrientedRectangle& one : a.bodies) {
    for (const OrientedRectangle& other : b.bodies) least_m = std::min(least_m, clearance_m(one, other));
  }
  return least_m;
}

Vec2 point(Draws& draws, double reach_m) {
  return {draws.uniform(-reach_m, reach_m), draws.uniform(-reach_m, reach_m)};
}

Sampled drawn(Draws& draws, const Vec2& about_m) {
  Sampled body({draws.uniform(0.6, 2.5), draws.uniform(0.4, 1.4), draws.uniform(-0.5, 0.5)});
  const Vec2 from_m = about_m + point(draws, 2.0);
  const Pose start{from_m, unit_vector(draws.uniform(-3.0, 3.0))};
  const std::uint32_t kind = draws.below(5);
  if (kind == 0) body.turn(start, 0.0);
  if (kind == 1) body.turn(start, draws.uniform(-3.1, 3.1));
  if (kind == 2) body.drive(Curve::straight(from_m, from_m + point(draws, 3.0)));
  if (kind >= 3) {
    const Curve bend =
        Curve::bezier(from_m, from_m + point(draws, 2.0), from_m + point(draws, 3.0), from_m + point(draws, 3.0));
    body.drive(kind == 3 ? bend : bend.tail_first());
  }
  return body;
}

// Of many pairs, at distances just below and just above the one that the poses show.
TEST(Sweep, TellsBodiesThatMayComeCloserFromThoseThatNeverDo) {
  Draws draws(20261130, 1, 1);
  int apart = 0;
  for (int i = 0; i < 120; ++i) {
    const Sampled a = drawn(draws, Vec2::Zero()), b = drawn(draws, point(draws, 5.0));
    const double seen_m = least_clearance_m(a, b);
    if (seen_m <= 0.02) {
      EXPECT_TRUE(may_come_closer(a.sweep, b.sweep, 0.1)) << "pair " << i << " overlaps";
      continue;
    }
    ++apart;
    EXPECT_TRUE(may_come_closer(a.sweep, b.sweep, seen_m + kNear_m)) << "pair " << i << ": a pose says so";
    EXPECT_TRUE(may_come_closer(b.sweep, a.sweep, seen_m + kNear_m)) << "pair " << i;
    const double certain_m = seen_m - 0.5 * (a.step_m + b.step_m) - kSweepSlack_m - kNear_m;
    EXPECT_FALSE(may_come_closer(a.sweep, b.sweep, certain_m)) << "pair " << i << ": " << seen_m << " m";
  }
  EXPECT_GT(apart, 40);
}

// Plants are built to the limit.
TEST(Sweep, IsExactForBodiesThatStandOrDriveStraightOn) {
  const Footprint footprint{1.6, 1.0};
  Sampled here(footprint), there(footprint);
  here.drive(Curve::straight({0.0, 0.0}, {10.0, 0.0}));
  there.drive(Curve::straight({10.0, 1.1}, {0.0, 1.1}));
  EXPECT_FALSE(may_come_closer(here.sweep, there.sweep, 0.1));
  EXPECT_FALSE(may_come_closer(here.sweep, there.sweep, 0.1 + 0.9 * kBuiltToTheLimit_m));
  EXPECT_TRUE(may_come_closer(here.sweep, there.sweep, 0.1 + 1.1 * kBuiltToTheLimit_m));
  Sampled stands(footprint);
  stands.turn({{11.7, 0.0}, Vec2::UnitX()}, 0.0);
  EXPECT_FALSE(may_come_closer(here.sweep, stands.sweep, 0.1));
  EXPECT_TRUE(may_come_closer(here.sweep, stands.sweep, 0.11));
}

TEST(Sweep, OfATurnReachesToTheCorners) {
  const Footprint footprint{1.6, 1.0};
  Sampled turns(footprint), stands(footprint);
  turns.turn({Vec2::Zero(), Vec2::UnitX()}, 2.0 * kPi);
  stands.turn({{0.0, footprint.reach_m() + 0.5 + 0.2}, Vec2::UnitX()}, 0.0);
  EXPECT_TRUE(may_come_closer(turns.sweep, stands.sweep, 0.201));
  EXPECT_FALSE(may_come_closer(turns.sweep, stands.sweep, 0.2 - kSweepSlack_m));
}

TEST(Sweep, ThatIsNowhereComesCloseToNobody) {
  const Sweep nowhere({1.6, 1.0});
  Sampled stands({1.6, 1.0});
  stands.turn({Vec2::Zero(), Vec2::UnitX()}, 0.0);
  EXPECT_FALSE(may_come_closer(nowhere, stands.sweep, 100.0));
}

}  // namespace
}  // namespace fleetproof::sweep_test
