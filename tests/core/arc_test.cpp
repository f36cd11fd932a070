#include "core/geometry/arc.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "core/base/tolerances.hpp"
#include "core/geometry/curve.hpp"
#include "core/geometry/rotation.hpp"
#include "tests/core/hard_beziers.hpp"
#include "tests/oracle/bezier_track.hpp"

namespace fleetproof::arc_test {
namespace {

using test::ControlPoints;
constexpr ArcTolerance kTolerance{kBezierByArcs_m, kHeadingByArcs_rad};

struct Deviation {
  double position_m = 0.0, heading_rad = 0.0;
};

// The largest distance of the arcs from the curve, and of their heading from that of the nearest point of the curve.
Deviation deviation(const ControlPoints& p, const std::vector<Arc>& arcs) {
  const oracle::BezierTrack track(test::points(p));
  Deviation most;
  double t = 0.0;
  const auto at = [&](double u) { return Vec2(track.at(u).x, track.at(u).y); };
  for (const Arc& arc : arcs) {
    for (int i = 0; i <= 16; ++i) {
      const Pose pose = arc.pose_at(arc.length_m * i / 16);
      // Newton's method from the parameter of the point before.
      for (int k = 0; k < 12; ++k) {
        const oracle::Point along = track.tangent(t);
        const Vec2 way(along.x, along.y);
        t = std::clamp(t + (pose.position_m - at(t)).dot(way) / way.squaredNorm(), 0.0, 1.0);
      }
      const oracle::Point along = track.tangent(t);
      most.position_m = std::max(most.position_m, (pose.position_m - at(t)).norm());
      most.heading_rad =
          std::max(most.heading_rad, std::abs(angle_between(Vec2(along.x, along.y).normalized(), pose.heading)));
    }
  }
  return most;
}

TEST(Biarc, ChainsStayNearInPlaceAndHeadingRunSmoothAndEndExactly) {
  std::mt19937_64 engine(5);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Deviation most;
  for (int i = 0; i < 60; ++i) {
    const Vec2 origin(1000.0 * unit(engine), 1000.0 * unit(engine));
    const double size_m = 2.0 + 20.0 * unit(engine), bulge = 0.2 + 0.5 * unit(engine);
    const Vec2 out = unit_vector(1.5 * (unit(engine) - 0.5)), in = unit_vector(3.0 * (unit(engine) - 0.5));
    const ControlPoints p{origin, origin + bulge * size_m * out, origin + Vec2(size_m, 0.0) - bulge * size_m * in,
                          origin + Vec2(size_m, 0.0)};
    const std::vector<Arc> arcs = biarc_chain(p, kTolerance);
    const Curve chain = Curve::chain(arcs);
    ASSERT_NO_FATAL_FAILURE(test::expect_joined(chain, p[0], p[3]));
    const Deviation here = deviation(p, arcs);
    ASSERT_LT(here.position_m, kTolerance.position_m) << i;
    ASSERT_LT(here.heading_rad, kTolerance.heading_rad) << i;
    most = {std::max(most.position_m, here.position_m), std::max(most.heading_rad, here.heading_rad)};
    ASSERT_LT((chain.pose_at(0.0).heading - out).norm(), 1e-9);
    ASSERT_LT((chain.pose_at(chain.length_m()).heading - in).norm(), 1e-9);
    ASSERT_LT(arcs.size(), 200U);
  }
  EXPECT_GT(most.position_m, 0.2 * kTolerance.position_m) << "no more arcs than it takes";
}

TEST(Biarc, QuarterTurnTakesFewArcs) {
  const double k = 0.5522847498;
  const ControlPoints p{Vec2(0, 0), Vec2(2 * k, 0), Vec2(2, 2 - 2 * k), Vec2(2, 2)};
  const std::vector<Arc> arcs = biarc_chain(p, kTolerance);
  EXPECT_LE(arcs.size(), 16U);
  EXPECT_NEAR(Curve::chain(arcs).length_m(), kPi, 2e-3);
}

TEST(Biarc, DegenerateBeziersStayFiniteAndSmooth) {
  for (const ControlPoints& p : test::hard_beziers()) {
    const Curve chain = Curve::chain(biarc_chain(p, kTolerance));
    ASSERT_NO_FATAL_FAILURE(test::expect_joined(chain, p[0], p[3])) << p[1].transpose() << " / " << p[2].transpose();
    EXPECT_LT(chain.parts().size(), 1000U);
    EXPECT_LT(chain.length_m(), 20.0);
  }
}

}  // namespace
}  // namespace fleetproof::arc_test
