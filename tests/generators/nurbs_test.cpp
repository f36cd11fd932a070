#include "generators/formats/nurbs.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/tolerances.hpp"
#include "generators/map/layout_check.hpp"
#include "independent_check.hpp"

namespace fleetproof::nurbs_test {
namespace {

// The basis functions by their recursive definition (Cox and de Boor), which the product does not use.
double basis(const Nurbs& n, std::size_t i, std::size_t degree, double u) {
  if (degree == 0) return n.knots[i] <= u && u < n.knots[i + 1] ? 1.0 : 0.0;
  const double left = n.knots[i + degree] - n.knots[i], right = n.knots[i + degree + 1] - n.knots[i + 1];
  return (left > 0.0 ? (u - n.knots[i]) / left * basis(n, i, degree - 1, u) : 0.0) +
         (right > 0.0 ? (n.knots[i + degree + 1] - u) / right * basis(n, i + 1, degree - 1, u) : 0.0);
}

Vec2 point(const Nurbs& n, double u) {
  Vec2 sum = Vec2::Zero();
  double weight = 0.0;
  for (std::size_t i = 0; i < n.points_m.size(); ++i) {
    const double share = n.weights[i] * basis(n, i, n.degree, u);
    sum += n.points_m[i] * share;
    weight += share;
  }
  return sum / weight;
}

Segment segment_of(const CubicPieces& pieces) {
  Segment segment;
  segment.from = StationId{std::size_t{0}};
  segment.to = StationId{std::size_t{1}};
  segment.control_points_m = pieces.control_points_m;
  return segment;
}

Layout between(const CubicPieces& pieces) {
  Layout layout;
  layout.stations = {{"a", pieces.begin_m, Purpose::Routing}, {"b", pieces.end_m, Purpose::Routing}};
  return layout;
}

Nurbs spline(std::size_t degree, std::vector<double> knots, std::vector<Vec2> points) {
  const auto count = points.size();
  return {degree, std::move(knots), std::move(points), std::vector<double>(count, 1.0)};
}

TEST(Nurbs, SplinesAreFollowedWithinAMillimetre) {
  auto smooth = spline(3, {0, 0, 0, 0, 0.4, 1, 1, 1, 1}, {{0, 0}, {2, 0}, {4, 2}, {4, 4}, {4, 6}});
  smooth.weights[2] = 1.5;
  const auto open = spline(3, {0, 1, 2, 3, 4, 5, 6, 7, 8}, {{0, 0}, {2, 0}, {4, 2}, {4, 4}, {4, 6}});
  for (const auto& nurbs : {smooth, open}) {
    ASSERT_EQ(fault_of(nurbs), "");
    const auto pieces = cubic_pieces(nurbs);
    EXPECT_EQ(pieces.off_m, kNurbsByCubics_m);
    const auto layout = between(pieces);
    const auto segment = segment_of(pieces);
    const double low = nurbs.knots[3], high = nurbs.knots[5];
    for (int k = 0; k < 100; ++k)
      EXPECT_LT(independent::distance_to_segment_m(layout, segment, point(nurbs, low + (high - low) * k / 100.0)),
                0.001);
  }
}

// A quarter circle is a rational curve: its places and headings are known without the curve.
TEST(Nurbs, RationalCirclesKeepACornerAtThreeMetresWithinTenMicrometres) {
  constexpr double kReach_m = 3.0;
  for (const double radius_m : {0.8, 2.0, 6.0}) {
    const Nurbs nurbs{2,
                      {0, 0, 0, 1, 1, 1},
                      {Vec2(radius_m, 0.0), Vec2(radius_m, radius_m), Vec2(0.0, radius_m)},
                      {1.0, std::sqrt(0.5), 1.0}};
    const auto pieces = cubic_pieces(nurbs);
    EXPECT_EQ(pieces.off_m, kNurbsByCubics_m);
    const Curve curve = segment_curve(between(pieces), segment_of(pieces));
    for (int i = 0; i <= 1'000; ++i) {
      const Pose pose = curve.pose_at(curve.length_m() * i / 1'000);
      const double off_m = std::abs(pose.position_m.norm() - radius_m),
                   off_rad = std::abs(pose.heading.dot(pose.position_m.normalized()));
      ASSERT_LT(off_m + kReach_m * off_rad, 10e-6) << radius_m << " " << i;
    }
    EXPECT_LT(curve.parts().size(), 150U);
  }
}

// A clamped spline with the same corner twice has a corner there, whatever its weights.
TEST(Nurbs, CornersOfSplinesRemain) {
  auto corner = spline(2, {0, 0, 0, 0.5, 0.5, 1, 1, 1}, {{0, 0}, {2, 0}, {4, 0}, {4, 2}, {4, 4}});
  corner.weights[1] = 1.01;
  const auto segment = segment_of(cubic_pieces(corner));
  EXPECT_NEAR(largest_kink_rad(segment), std::acos(0.0), 1e-6);
  for (const Vec2& point_m : segment.control_points_m) EXPECT_TRUE(point_m.y() == 0.0 || point_m.x() == 4.0) << point_m;
}

TEST(Nurbs, JoinedBezierCurvesAreExact) {
  const std::vector<Vec2> points = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {5, 1}, {5, 2}};
  const auto pieces = cubic_pieces(spline(3, {0, 0, 0, 0, 0.3, 0.3, 0.3, 1, 1, 1, 1}, points));
  EXPECT_EQ(pieces.off_m, 0.0);
  EXPECT_EQ(pieces.control_points_m, std::vector<Vec2>(points.begin() + 1, points.end() - 1));
}

TEST(Nurbs, FaultsNameTheNumbers) {
  EXPECT_EQ(fault_of(spline(0, {}, {})), "degree 0 is not between 1 and 9");
  EXPECT_EQ(fault_of(spline(2, {0, 0, 1, 1}, {{0, 0}, {1, 1}})),
            "degree 2 needs at least 3 control points; here are 2");
  EXPECT_EQ(fault_of(spline(1, {0, 0, 0, 0}, {{0, 0}, {1, 1}})), "all knots are equal; they run from 0 to 1");
  auto weightless = spline(1, {0, 0, 1, 1}, {{0, 0}, {1, 1}});
  weightless.weights[1] = 0.0;
  EXPECT_EQ(fault_of(weightless), "weight 0 is not positive; correct it, or leave it out for 1");
}

}  // namespace
}  // namespace fleetproof::nurbs_test
