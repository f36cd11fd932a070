#include "laws/side_by_side.hpp"

#include <gtest/gtest.h>

namespace fleetproof::test::side_by_side_test {
namespace {

constexpr double kMargin_m = 0.1;

Track track(const Curve& curve, const Footprint& footprint = {}) { return Track::of(curve, footprint); }

Curve line(double y_m) { return Curve::straight({0.0, y_m}, {20.0, y_m}); }

// A quarter turn about the origin.
Curve quarter(double radius_m) {
  const double c = 0.5522847498 * radius_m;
  return Curve::bezier({radius_m, 0.0}, {radius_m, c}, {c, radius_m}, {0.0, radius_m});
}

// Comes from above and ends along the x axis at this height.
Curve swing_down_to(double y_m) { return Curve::bezier({5.0, y_m + 3.0}, {5.0, y_m + 1.3}, {6.3, y_m}, {8.0, y_m}); }

SideBySide beside(const Curve& a, const Curve& b) { return side_by_side(track(a), track(b), kMargin_m); }

TEST(TightGap, IsZeroToTwelveCentimetresBetweenBandsThatRunAlongEachOther) {
  EXPECT_FALSE(beside(line(0.0), line(0.99)).tight_gap) << "the bands overlap";
  EXPECT_TRUE(beside(line(0.0), line(1.0)).tight_gap);
  EXPECT_TRUE(beside(line(0.0), line(1.12)).tight_gap);
  EXPECT_TRUE(beside(line(1.12), line(0.0).reversed()).tight_gap);
  EXPECT_FALSE(beside(line(0.0), line(1.13)).tight_gap);
}

TEST(TightGap, DependsOnTheWidthsOfTheBodies) {
  const Track wide = track(line(0.0), {1.6, 1.3});
  EXPECT_TRUE(side_by_side(wide, track(line(1.2)), kMargin_m).tight_gap);
  EXPECT_FALSE(side_by_side(wide, track(line(1.3)), kMargin_m).tight_gap);
}

TEST(TightGap, IsNotBetweenLanesAtAnAngle) {
  const Curve across = Curve::straight({21.9, -5.0}, {21.9, 5.0});  // in front of the other's nose
  EXPECT_FALSE(beside(line(0.0), across).tight_gap);
}

// 0.05 m more than the bodies need beside each other.
TEST(TightGap, IsNotBetweenLanesOneBehindTheOther) {
  const double end_m = 20.0 + 0.8 + 0.8;  // of the tracks: half a body beyond both ends
  const auto behind = [&](double gap_m, double y_m) {
    return Curve::straight({end_m + 1.0 + gap_m, y_m}, {end_m + 20.0, y_m});
  };
  EXPECT_FALSE(beside(line(0.0), behind(0.05, 0.0)).tight_gap);
  EXPECT_FALSE(beside(behind(0.05, 0.0), line(0.0)).tight_gap);
  EXPECT_FALSE(beside(line(0.0), behind(0.05, 0.0).reversed()).tight_gap);
  EXPECT_TRUE(beside(line(0.0), behind(-2.0, 1.05)).tight_gap) << "a metre of them is beside each other";
}

TEST(CurveBesideLane, IsABodyInABendWithinThirtyCentimetres) {
  EXPECT_TRUE(beside(line(0.0), swing_down_to(1.25)).curve_beside_lane);
  EXPECT_TRUE(beside(swing_down_to(1.25), line(0.0)).curve_beside_lane);
  EXPECT_FALSE(beside(line(0.0), swing_down_to(1.6)).curve_beside_lane);
  EXPECT_FALSE(beside(line(0.0), line(1.25)).curve_beside_lane) << "no bend";
  EXPECT_FALSE(beside(line(0.0), swing_down_to(0.5)).curve_beside_lane) << "one floor: they merge";
}

// On a radius of 1.2 m, the outer corner of a body of 1.6 m x 1.0 m reaches sqrt(1.7^2 + 0.8^2) - 1.7 = 0.179 m beyond
// its band.
TEST(OverhangPass, IsACornerThatReachesBeyondItsBand) {
  const auto gap = [](double gap_m) { return beside(quarter(1.2), quarter(1.2 + 1.0 + gap_m)); };
  EXPECT_TRUE(gap(0.15).overhang_pass);
  EXPECT_TRUE(gap(0.25).overhang_pass);
  EXPECT_FALSE(gap(0.30).overhang_pass);
  EXPECT_TRUE(gap(0.30).curve_beside_lane);
  EXPECT_FALSE(gap(0.52).curve_beside_lane);
  EXPECT_FALSE(gap(0.05).overhang_pass) << "the bands themselves are too near";
  EXPECT_FALSE(beside(line(0.0), line(1.05)).overhang_pass);
}

// Recounted with bodies every 2 cm, by their corners only.
TEST(OverhangPass, AgreesWithBodiesEveryTwoCentimetres) {
  for (int i = 0; i < 20; ++i) {
    const double gap_m = 0.12 + 0.02 * i;
    const Curve inner = quarter(1.2), outer = quarter(2.2 + gap_m);
    double least_m = 1e300;
    for (double s_m = 0.0; s_m <= inner.length_m(); s_m += 0.02) {
      const Pose pose = inner.pose_at(s_m);
      const Vec2 across(pose.heading.y(), -pose.heading.x());
      for (const double end_m : {0.8, -0.8}) {
        const Vec2 corner = pose.position_m + end_m * pose.heading + 0.5 * across;
        for (double t_m = 0.0; t_m <= outer.length_m(); t_m += 0.02) {
          const Pose other = outer.pose_at(t_m);
          const Vec2 to = corner - other.position_m;
          const double along_m = std::abs(to.dot(other.heading)) - 0.8,
                       aside_m = std::abs(to.x() * other.heading.y() - to.y() * other.heading.x()) - 0.5;
          if (along_m <= 0.0) least_m = std::min(least_m, aside_m);
        }
      }
    }
    if (std::abs(least_m - kMargin_m) < 0.03) continue;  // what lies between points 0.4 m apart
    EXPECT_EQ(beside(inner, outer).overhang_pass, least_m < kMargin_m) << gap_m;
  }
}

}  // namespace
}  // namespace fleetproof::test::side_by_side_test
