#include "core/geometry/curve.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "core/base/tolerances.hpp"
#include "core/geometry/rotation.hpp"
#include "tests/core/hard_beziers.hpp"
#include "tests/oracle/bezier_track.hpp"

namespace fleetproof::curve_test {
namespace {

using test::ControlPoints;
using test::expect_joined;

Curve curve_of(const ControlPoints& p) { return Curve::bezier(p[0], p[1], p[2], p[3]); }

ControlPoints drawn(std::mt19937_64& engine) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const Vec2 origin(1000.0 * unit(engine), 1000.0 * unit(engine));
  const double size_m = 2.0 + 20.0 * unit(engine), bulge = 0.2 + 0.5 * unit(engine);
  const Vec2 out = unit_vector(1.5 * (unit(engine) - 0.5)), in = unit_vector(3.0 * (unit(engine) - 0.5));
  return {origin, origin + bulge * size_m * out, origin + Vec2(size_m, 0.0) - bulge * size_m * in,
          origin + Vec2(size_m, 0.0)};
}

// A corner 3 m from the reference point is where the definition puts it, to a nanometre.
TEST(Curve, ABezierCurveIsItselfByArcLength) {
  constexpr double kReach_m = 3.0;
  std::mt19937_64 engine(5);
  std::size_t most_parts = 0;
  for (int i = 0; i < 200; ++i) {
    const ControlPoints p = drawn(engine);
    const Curve curve = curve_of(p);
    const oracle::BezierTrack track(
        test::points({Vec2::Zero(), Vec2(p[1] - p[0]), Vec2(p[2] - p[0]), Vec2(p[3] - p[0])}));
    ASSERT_NO_FATAL_FAILURE(expect_joined(curve, p[0], p[3]));
    ASSERT_NEAR(curve.length_m(), track.length(), 1e-11);
    for (int k = 0; k <= 500; ++k) {
      const double way_m = curve.length_m() * k / 500, t = track.parameter(way_m);
      const oracle::Point at = track.at(t), along = track.tangent(t);
      const Pose pose = curve.pose_at(way_m);
      const double off_m = (pose.position_m - p[0] - Vec2(at.x, at.y)).norm(),
                   off_rad = (pose.heading - Vec2(along.x, along.y).normalized()).norm();
      ASSERT_LT(off_m, kAlongCurve_m + 1e-12) << i;
      ASSERT_LT(off_m + kReach_m * off_rad, 1e-9) << i;
      ASSERT_NEAR(curve.bending_at(way_m).per_m, track.bend_at(t), 1e-8);
    }
    most_parts = std::max(most_parts, curve.parts().size());
  }
  EXPECT_GT(most_parts, 2U);
  EXPECT_LT(most_parts, 80U);
}

// The bounds of each part hold, and are not far from what is there.
TEST(Curve, KnowsHowSharplyItsPartsBend) {
  std::mt19937_64 engine(6);
  double looseness = 0.0;
  int parts = 0;
  for (int i = 0; i < 100; ++i) {
    const Curve curve = curve_of(drawn(engine));
    for (const CurvePart& part : curve.parts()) {
      constexpr int kSamples = 100;
      MostBending seen;
      Bending last = part.bending_at(0.0);
      const double step_m = part.length_m() / kSamples;
      for (int k = 1; k <= kSamples; ++k) {
        const Bending here = part.bending_at(step_m * k);
        seen.per_m = std::max(seen.per_m, std::abs(here.per_m));
        seen.per_m2 = std::max({seen.per_m2, std::abs(here.per_m2), std::abs(here.per_m - last.per_m) / step_m});
        seen.per_m3 = std::max(seen.per_m3, std::abs(here.per_m2 - last.per_m2) / step_m);
        last = here;
      }
      constexpr double kRounding = 1.0 + 1e-6;
      ASSERT_LE(seen.per_m, part.most().per_m * kRounding);
      ASSERT_LE(seen.per_m2, part.most().per_m2 * kRounding + 1e-6);
      ASSERT_LE(seen.per_m3, part.most().per_m3 * kRounding + 1e-4);
      looseness += part.most().per_m / seen.per_m;
      ++parts;
    }
  }
  EXPECT_LT(looseness / parts, 1.2);
}

TEST(Curve, QuarterTurnTakesFewParts) {
  const double k = 0.5522847498;
  const Curve curve = curve_of({Vec2(0, 0), Vec2(2 * k, 0), Vec2(2, 2 - 2 * k), Vec2(2, 2)});
  EXPECT_LE(curve.parts().size(), 10U);
  EXPECT_NEAR(curve.length_m(), kPi, 2e-3);
}

TEST(Curve, StraightBeziersAreOneLine) {
  const Vec2 from(3.0, 4.0), way(8.0, 6.0);
  for (const auto& [a, b] :
       {std::pair{1.0 / 3.0, 2.0 / 3.0}, std::pair{0.0, 1.0}, std::pair{0.0, 0.0}, std::pair{0.9, 0.1}}) {
    const Curve curve = Curve::bezier(from, from + a * way, from + b * way, from + way);
    EXPECT_TRUE(curve.is_straight());
    EXPECT_DOUBLE_EQ(curve.length_m(), 10.0);
  }
}

TEST(Curve, DegenerateBeziersStayFiniteAndSmooth) {
  const auto hard = test::hard_beziers();
  for (const ControlPoints& p : hard) {
    const Curve curve = curve_of(p);
    ASSERT_NO_FATAL_FAILURE(expect_joined(curve, p[0], p[3])) << p[1].transpose() << " / " << p[2].transpose();
    EXPECT_LT(curve.parts().size(), 400U);
    EXPECT_LT(curve.length_m(), 20.0);
  }
  EXPECT_GT(curve_of(hard[6]).length_m(), 1.0);
  EXPECT_EQ(curve_of(hard[10]).length_m(), 0.0);
}

TEST(Curve, ArcIsExactAlsoForVastRadii) {
  const Pose start{{100.0, 50.0}, unit_vector(0.3)};
  for (const double curvature : {0.5, -0.5, 1e-3, 1e-7, -1e-9, 1e-12}) {
    const Arc arc{start, 20.0, curvature};
    for (const double s : {0.0, 1.0, 7.5, 20.0}) {
      const long double a = static_cast<long double>(curvature) * s;
      const auto ahead = static_cast<double>(std::abs(a) < 1e-4L ? s * (1 - a * a / 6) : std::sin(a) / curvature);
      const auto aside = static_cast<double>(std::abs(a) < 1e-4L ? s * a / 2 : (1 - std::cos(a)) / curvature);
      const Pose pose = arc.pose_at(s);
      EXPECT_NEAR((start.position_m + ahead * start.heading + aside * left_of(start.heading) - pose.position_m).norm(),
                  0.0, 1e-13);
      EXPECT_NEAR((rotated(start.heading, unit_vector(static_cast<double>(a))) - pose.heading).norm(), 0.0, 1e-14);
    }
  }
}

TEST(Curve, ClampsReversesMovesAndJoins) {
  const Curve bend = Curve::bezier({0, 0}, {3, 0}, {5, 2}, {5, 6}), line = Curve::straight({5, 6}, {5, 9});
  const Curve both = Curve::joined(std::array{bend, line});
  EXPECT_DOUBLE_EQ(both.length_m(), bend.length_m() + 3.0);
  EXPECT_LT((both.pose_at(1e9).position_m - Vec2(5, 9)).norm(), 1e-9);
  EXPECT_LT((both.pose_at(-1.0).position_m - Vec2(0, 0)).norm(), 1e-12);
  EXPECT_LT((both.pose_at(bend.length_m() + 1.0).position_m - Vec2(5, 7)).norm(), 1e-9);
  const Curve back = both.reversed(), moved = both.moved({1.0, -2.0});
  ASSERT_NO_FATAL_FAILURE(expect_joined(back, {5, 9}, {0, 0}));
  for (int i = 0; i <= 40; ++i) {
    const double s = both.length_m() * i / 40.0, rest = both.length_m() - s;
    const Pose there = both.pose_at(s), again = back.pose_at(rest);
    EXPECT_LT((there.position_m - again.position_m).norm(), 1e-9);
    EXPECT_LT((there.heading + again.heading).norm(), 1e-9);
    EXPECT_LT((moved.pose_at(s).position_m - there.position_m - Vec2(1.0, -2.0)).norm(), 1e-12);
    if (s == bend.length_m() || i == 0) continue;
    EXPECT_NEAR(back.bending_at(rest).per_m, -both.bending_at(s).per_m, 1e-9);
    EXPECT_NEAR(back.bending_at(rest).per_m2, both.bending_at(s).per_m2, 1e-9);
  }
  for (std::size_t i = 0; i + 1 < both.ends_m().size(); ++i) EXPECT_EQ(both.part_at(both.ends_m()[i]), i + 1);
  EXPECT_EQ(both.part_at(both.length_m()), both.parts().size() - 1);
  EXPECT_EQ(Curve::straight({1, 2}, {1, 2}).length_m(), 0.0);
  EXPECT_TRUE(Curve::straight({1, 2}, {1, 2}).pose_at(0.0).heading.allFinite());
}

}  // namespace
}  // namespace fleetproof::curve_test
