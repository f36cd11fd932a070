#include "core/geometry/curve.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "core/geometry/rotation.hpp"

namespace fleetproof {
namespace {

using ControlPoints = std::array<Vec2, 4>;
constexpr double kTolerance_m = 1e-3;

Vec2 de_casteljau(ControlPoints p, double t) {
  for (std::size_t left = 3; left > 0; --left) {
    for (std::size_t i = 0; i < left; ++i) p[i] = (1.0 - t) * p[i] + t * p[i + 1];
  }
  return p[0];
}

Curve chain_of(const ControlPoints& p) { return Curve::bezier(p[0], p[1], p[2], p[3], kTolerance_m); }

double distance_to_polyline_m(const std::vector<Vec2>& line, const Vec2& p) {
  double least = 1e300;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Vec2 way = line[i + 1] - line[i];
    const double square = way.squaredNorm(),
                 t = square > 0.0 ? std::clamp(way.dot(p - line[i]) / square, 0.0, 1.0) : 0.0;
    least = std::min(least, (line[i] + t * way - p).norm());
  }
  return least;
}

// Both ways: no point of either lies farther than the tolerance from the other.
void expect_close(const ControlPoints& p, const Curve& chain) {
  constexpr int kDense = 1500;
  std::vector<Vec2> bezier, arcs;
  for (int i = 0; i <= kDense; ++i) {
    bezier.push_back(de_casteljau(p, static_cast<double>(i) / kDense));
    arcs.push_back(chain.pose_at(chain.length_m() * i / kDense).position_m);
  }
  const double slack_m = 1e-5;  // of the polylines
  for (int i = 0; i <= kDense; i += 5) {
    ASSERT_LT(distance_to_polyline_m(arcs, bezier[static_cast<std::size_t>(i)]), kTolerance_m + slack_m);
    ASSERT_LT(distance_to_polyline_m(bezier, arcs[static_cast<std::size_t>(i)]), kTolerance_m + slack_m);
  }
}

void expect_joined(const Curve& chain, const Vec2& from, const Vec2& to) {
  const auto arcs = chain.arcs();
  ASSERT_FALSE(arcs.empty());
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    ASSERT_TRUE(std::isfinite(arcs[i].length_m) && std::isfinite(arcs[i].curvature_per_m));
    ASSERT_GE(arcs[i].length_m, 0.0);
    ASSERT_NEAR(arcs[i].start.heading.norm(), 1.0, 1e-12);
    if (i == 0) continue;
    const Pose end = arcs[i - 1].pose_at(arcs[i - 1].length_m);
    ASSERT_LT((end.position_m - arcs[i].start.position_m).norm(), 1e-9);
    ASSERT_LT((end.heading - arcs[i].start.heading).norm(), 1e-9);
  }
  ASSERT_LT((chain.pose_at(0.0).position_m - from).norm(), 1e-12);
  ASSERT_LT((chain.pose_at(chain.length_m()).position_m - to).norm(), 1e-9);
}

TEST(Curve, BezierChainsStayNearRunSmoothAndEndExactly) {
  std::mt19937_64 engine(5);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::size_t most_arcs = 0;
  for (int i = 0; i < 60; ++i) {
    const Vec2 origin(1000.0 * unit(engine), 1000.0 * unit(engine));
    const double size_m = 2.0 + 20.0 * unit(engine), bulge = 0.2 + 0.5 * unit(engine);
    const Vec2 out = unit_vector(1.5 * (unit(engine) - 0.5)), in = unit_vector(3.0 * (unit(engine) - 0.5));
    const ControlPoints p{origin, origin + bulge * size_m * out, origin + Vec2(size_m, 0.0) - bulge * size_m * in,
                          origin + Vec2(size_m, 0.0)};
    const Curve chain = chain_of(p);
    ASSERT_NO_FATAL_FAILURE(expect_joined(chain, p[0], p[3]));
    ASSERT_NO_FATAL_FAILURE(expect_close(p, chain));
    ASSERT_LT((chain.pose_at(0.0).heading - out).norm(), 1e-9);
    ASSERT_LT((chain.pose_at(chain.length_m()).heading - in).norm(), 1e-9);
    most_arcs = std::max(most_arcs, chain.arcs().size());
  }
  EXPECT_GT(most_arcs, 2U);
  EXPECT_LT(most_arcs, 80U);
}

TEST(Curve, QuarterTurnTakesFewArcs) {
  const double k = 0.5522847498;
  const ControlPoints p{Vec2(0, 0), Vec2(2 * k, 0), Vec2(2, 2 - 2 * k), Vec2(2, 2)};
  const Curve chain = chain_of(p);
  EXPECT_LE(chain.arcs().size(), 4U);
  EXPECT_NEAR(chain.length_m(), kPi, 2e-3);
  ASSERT_NO_FATAL_FAILURE(expect_close(p, chain));
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
  const Vec2 o(0, 0);
  const std::vector<ControlPoints> hard{{o, Vec2(1, 1), Vec2(0, 1), Vec2(1, 0)},     // a cusp
                                        {o, Vec2(3, 3), Vec2(-2, 3), Vec2(1, 0)},    // a loop
                                        {o, o, Vec2(2, 1), Vec2(3, 3)},              // first control point on the end
                                        {o, Vec2(2, 0), Vec2(3, 3), Vec2(3, 3)},     // last one
                                        {o, o, Vec2(3, 3), Vec2(3, 3)},              // both: a line
                                        {o, Vec2(-1, 0), Vec2(2, 0), Vec2(1, 0)},    // straight, but doubling back
                                        {o, Vec2(1, 0), Vec2(0, 1), o},              // closed
                                        {o, Vec2(3, 3), Vec2(-3, -3), o},            // closed and straight
                                        {o, Vec2(1, 0), Vec2(1, 0), Vec2(0, 1e-6)},  // ends nearly together
                                        {o, Vec2(1e-11, 0), Vec2(0, 1e-11), Vec2(1e-11, 1e-11)},  // next to nothing
                                        {Vec2(7, 7), Vec2(7, 7), Vec2(7, 7), Vec2(7, 7)},         // nothing
                                        {o, Vec2(0, 1e-13), Vec2(1, 1e-13), Vec2(1, 0)}};
  for (const ControlPoints& p : hard) {
    const Curve chain = chain_of(p);
    ASSERT_NO_FATAL_FAILURE(expect_joined(chain, p[0], p[3])) << p[1].transpose() << " / " << p[2].transpose();
    EXPECT_LT(chain.arcs().size(), 400U);
    EXPECT_LT(chain.length_m(), 20.0);
  }
  EXPECT_GT(chain_of(hard[6]).length_m(), 1.0);
  EXPECT_EQ(chain_of(hard[10]).length_m(), 0.0);
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

TEST(Curve, ClampsReversesAndJoins) {
  const Curve bend = Curve::bezier({0, 0}, {3, 0}, {5, 2}, {5, 6}), line = Curve::straight({5, 6}, {5, 9});
  const Curve both = Curve::joined(std::array{bend, line});
  EXPECT_DOUBLE_EQ(both.length_m(), bend.length_m() + 3.0);
  EXPECT_LT((both.pose_at(1e9).position_m - Vec2(5, 9)).norm(), 1e-9);
  EXPECT_LT((both.pose_at(-1.0).position_m - Vec2(0, 0)).norm(), 1e-12);
  EXPECT_LT((both.pose_at(bend.length_m() + 1.0).position_m - Vec2(5, 7)).norm(), 1e-9);
  const Curve back = both.reversed();
  ASSERT_NO_FATAL_FAILURE(expect_joined(back, {5, 9}, {0, 0}));
  for (int i = 0; i <= 40; ++i) {
    const double s = both.length_m() * i / 40.0;
    const Pose there = both.pose_at(s), again = back.pose_at(both.length_m() - s);
    EXPECT_LT((there.position_m - again.position_m).norm(), 1e-9);
    EXPECT_LT((there.heading + again.heading).norm(), 1e-9);
  }
  for (std::size_t i = 0; i + 1 < both.ends_m().size(); ++i)
    EXPECT_EQ(&both.arc_at(both.ends_m()[i]), &both.arcs()[i + 1]);
  EXPECT_EQ(&both.arc_at(both.length_m()), &both.arcs().back());
  EXPECT_EQ(Curve::straight({1, 2}, {1, 2}).length_m(), 0.0);
  EXPECT_TRUE(Curve::straight({1, 2}, {1, 2}).pose_at(0.0).heading.allFinite());
}

}  // namespace
}  // namespace fleetproof
