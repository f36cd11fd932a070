// Lanes side by side at exactly the safety distance: lines, bends, and both ways.
#include <gtest/gtest.h>

#include <array>

#include "generators/formats/nurbs.hpp"
#include "laws/exact_law.hpp"
#include "tests/laws/timeline.hpp"
#include "tests/oracle/brute_force.hpp"
#include "tests/oracle/known_pairs.hpp"

namespace fleetproof::test::curved_lanes_test {
namespace {

using oracle::Point;
using Cubics = std::vector<std::array<Point, 4>>;

constexpr double kLength_m = 1.6, kWidth_m = 1.0, kSafe_m = 0.10;  // the default footprint and distance

Curve curve_of(const Cubics& cubics) {
  std::vector<Curve> curves;
  for (const auto& p : cubics) curves.push_back(Curve::bezier(vec(p[0]), vec(p[1]), vec(p[2]), vec(p[3])));
  return Curve::joined(curves);
}

Cubics backwards(Cubics cubics) {
  std::ranges::reverse(cubics);
  for (auto& p : cubics) std::ranges::reverse(p);
  return cubics;
}

// The line beside a cubic curve, as cubic pieces with its places and tangents.
Cubics beside(const std::array<Point, 4>& control_points, double by_m, int pieces) {
  const oracle::BezierTrack track(control_points);
  const auto place = [&](double t) {
    const Point along = track.tangent(t);
    return track.at(t) + (by_m / oracle::length(along)) * oracle::left_of(along);
  };
  const auto rate = [&](double t) { return (1.0 - by_m * track.bend_at(t)) * track.tangent(t); };
  Cubics result;
  for (int i = 0; i < pieces; ++i) {
    const double from = 1.0 * i / pieces, to = 1.0 * (i + 1) / pieces, third = 1.0 / (3.0 * pieces);
    result.push_back({place(from), place(from) + third * rate(from), place(to) - third * rate(to), place(to)});
  }
  return result;
}

oracle::Trajectory trajectory(const Cubics& cubics, double begin_s) {
  oracle::Trajectory t;
  t.manner = oracle::Manner::Drive;
  t.body_length = kLength_m, t.body_width = kWidth_m;
  double way_m = 0.0;
  for (const auto& p : cubics) {
    t.strokes.push_back(oracle::bezier_stroke(p));
    way_m += t.strokes.back().length;
  }
  t.profile = oracle::Trapezoid(way_m, t.limits);
  t.begin = std::llround(1e9 * begin_s);
  t.end = t.begin + std::llround(1e9 * t.profile.duration_s());
  return t;
}

Scene two_drives(const Curve& one, const Curve& other, double other_begins_s) {
  Scene scene(60.0);
  scene.agv(one.pose_at(0.0)).drive(one);
  scene.agv(other.pose_at(0.0)).wait_until(other_begins_s).drive(other);
  return scene;
}

std::vector<Violation> violations(const Scene& scene) { return play(scene, make_exact_law).violations; }

// A lane, the lane beside it and when its AGV starts. `by_m` is tuned with the oracle: the smallest clearance of the
// two drives is the distance that is asked for.
struct LanePair {
  std::array<Point, 4> lane;
  bool opposite = false;
  double other_begins_s = 0.0, side = 1.0;

  Cubics other(double by_m) const {
    const Cubics lanes = beside(lane, side * by_m, 8);
    return opposite ? backwards(lanes) : lanes;
  }
  double smallest_m(double by_m) const {
    const oracle::Trajectory a = trajectory({lane}, 0.0), b = trajectory(other(by_m), other_begins_s);
    return oracle::lowest({a, b, b.begin, std::min(a.end, b.end)}).clearance_m;
  }
  Scene at(double clearance_m) const {
    double low = 1.1, high = 1.9;
    for (int i = 0; i < 28; ++i) {
      const double middle = 0.5 * (low + high);
      (smallest_m(middle) < clearance_m ? low : high) = middle;
    }
    EXPECT_NEAR(smallest_m(high), clearance_m, 1e-7);
    return two_drives(curve_of({lane}), curve_of(other(high)), other_begins_s);
  }
};

const std::vector<LanePair>& lane_pairs() {
  static const std::vector<LanePair> all = [] {
    const std::vector<std::array<Point, 4>> lanes{{{{0, 0}, {3, 0}, {5, 2}, {5, 6}}},     // a quarter turn
                                                  {{{0, 0}, {4, 0}, {3, 3}, {8, 3}}},     // to the next lane
                                                  {{{2, 1}, {7, 1}, {8, -4}, {3, -5}}}};  // nearly back
    std::vector<LanePair> pairs;
    for (const auto& lane : lanes) {
      pairs.push_back({lane, true, 0.4, 1.0});
      pairs.push_back({lane, false, 0.9, -1.0});
    }
    return pairs;
  }();
  return all;
}

TEST(CurvedLanes, AtExactlyTheDistanceAreNeverAccused) {
  for (const LanePair& pair : lane_pairs()) EXPECT_TRUE(violations(pair.at(kSafe_m)).empty());
}

TEST(CurvedLanes, AreAllowedTenMicrometresForEachBodyOnACurve) {
  for (const LanePair& pair : lane_pairs()) {
    EXPECT_TRUE(violations(pair.at(kSafe_m - 20e-6)).empty());
    const auto accused = violations(pair.at(kSafe_m - 30e-6));
    ASSERT_EQ(accused.size(), 1U);
    EXPECT_NEAR(static_cast<double>(accused[0].min_clearance_um), 99'969.5, 1.0);
  }
}

// A circle in cubic pieces of 30 degrees, from the x axis on: within 2 micrometres of a circle of 5 m.
Cubics quarter_circle(double radius_m) {
  Cubics result;
  for (int i = 0; i < 3; ++i) {
    const Point from = oracle::direction(kPi / 6.0 * i), to = oracle::direction(kPi / 6.0 * (i + 1));
    const double handle = 4.0 / 3.0 * std::tan(kPi / 24.0);
    result.push_back({radius_m * from, radius_m * (from + handle * oracle::left_of(from)),
                      radius_m * (to - handle * oracle::left_of(to)), radius_m * to});
  }
  return result;
}

// The hulls of two bodies on concentric bends are apart by the difference of the outer corners' circle and the inner
// sides' circle.
double outer_radius_m(double inner_radius_m, double apart_m) {
  return std::hypot(inner_radius_m + 0.5 * kWidth_m, 0.5 * kLength_m) + 0.5 * kWidth_m + apart_m;
}

int accused_on_bends(const Curve& inner, const Curve& outer) {
  int accused = 0;
  for (int k = 0; k < 12; ++k) {
    accused += violations(two_drives(inner, outer.reversed(), 0.3 * k)).empty() ? 0 : 1;
    accused += violations(two_drives(outer, inner, 0.3 * k)).empty() ? 0 : 1;
  }
  return accused;
}

TEST(CurvedLanes, HullsAtExactlyTheDistanceAreNeverAccusedWheneverTheDrivesBegin) {
  for (const double radius_m : {1.5, 3.0}) {
    const auto outer_at = [&](double apart_m) { return curve_of(quarter_circle(outer_radius_m(radius_m, apart_m))); };
    const Curve inner = curve_of(quarter_circle(radius_m));
    EXPECT_EQ(accused_on_bends(inner, outer_at(kSafe_m)), 0) << radius_m;
    EXPECT_GE(accused_on_bends(inner, outer_at(kSafe_m - 30e-6)), 10) << radius_m;
  }
}

// Circles as a layout file gives them: rational curves, which are imported as cubic pieces.
Curve imported_quarter_circle(double radius_m) {
  const Nurbs nurbs{2,
                    {0, 0, 0, 1, 1, 1},
                    {Vec2(radius_m, 0.0), Vec2(radius_m, radius_m), Vec2(0.0, radius_m)},
                    {1.0, std::sqrt(0.5), 1.0}};
  const CubicPieces pieces = cubic_pieces(nurbs);
  std::vector<Vec2> points{pieces.begin_m};
  points.insert(points.end(), pieces.control_points_m.begin(), pieces.control_points_m.end());
  points.push_back(pieces.end_m);
  std::vector<Curve> curves;
  for (std::size_t i = 0; i + 3 < points.size(); i += 3)
    curves.push_back(Curve::bezier(points[i], points[i + 1], points[i + 2], points[i + 3]));
  return Curve::joined(curves);
}

TEST(CurvedLanes, ImportedCirclesKeepTheDistanceToo) {
  const Curve inner = imported_quarter_circle(2.0);
  EXPECT_NEAR(inner.length_m(), kPi, 1e-5);
  EXPECT_EQ(accused_on_bends(inner, imported_quarter_circle(outer_radius_m(2.0, kSafe_m))), 0);
  EXPECT_GE(accused_on_bends(inner, imported_quarter_circle(outer_radius_m(2.0, kSafe_m - 30e-6))), 10);
}

TEST(CurvedLanes, StraightOnesAreJudgedToTheMicrometre) {
  for (const bool opposite : {false, true}) {
    const auto lanes = [&](double apart_m) {
      const Curve one = Curve::straight({0, 0}, {8, 6}), other = one.moved((kWidth_m + apart_m) * Vec2(-0.6, 0.8));
      return two_drives(one, opposite ? other.reversed() : other, 0.7);
    };
    EXPECT_TRUE(violations(lanes(kSafe_m)).empty());
    EXPECT_EQ(violations(lanes(kSafe_m - 2e-6)).size(), 1U);
  }
}

// A line beside the outer side of a bend: one of the bodies drives a curve.
TEST(CurvedLanes, BesideALineAreAllowedTenMicrometres) {
  const Curve bend = curve_of(quarter_circle(3.0));
  const auto line_at = [&](double apart_m) {
    const double x_m = std::hypot(3.0 + 0.5 * kWidth_m, 0.5 * kLength_m) + 0.5 * kWidth_m + apart_m;
    return two_drives(bend, Curve::straight({x_m, 0.9}, {x_m, -8.0}), 0.0);
  };
  EXPECT_TRUE(violations(line_at(kSafe_m)).empty());
  EXPECT_TRUE(violations(line_at(kSafe_m - 8e-6)).empty());
  EXPECT_EQ(violations(line_at(kSafe_m - 15e-6)).size(), 1U);
}

}  // namespace
}  // namespace fleetproof::test::curved_lanes_test
