#include "core/agents/hull.hpp"

#include <gtest/gtest.h>

#include <random>

#include "core/agents/shapes.hpp"
#include "tests/agents/drawn_map.hpp"
#include "tests/agents/rectangles.hpp"

namespace fleetproof::agents::hull_test {
namespace {

using testing::DrawnMap;
using testing::TestFleet;

fp_pose pose(double x, double y, double angle) { return {x, y, std::cos(angle), std::sin(angle)}; }
Shape body(const fp_pose& p, double length_m, double width_m) {
  return body_at({p.x_m, p.y_m}, {p.heading_x, p.heading_y}, {length_m, width_m});
}

double distance_m(Vec p, const Shape& s) {
  const Vec d = p - s.centre_m;
  const double along = std::max(std::abs(dot(d, s.axis)) - s.half_length_m, 0.0),
               across = std::max(std::abs(dot(d, left_of(s.axis))) - s.half_width_m, 0.0);
  return std::hypot(along, across) - s.radius_m;
}

TEST(AgentShapes, TurnLikeTheTrigonometricFunctions) {
  for (double angle = -7.0; angle < 7.0; angle += 0.0371) {
    const Vec v = turned({1.0, 0.0}, angle);
    EXPECT_NEAR(v.x, std::cos(angle), 1e-14);
    EXPECT_NEAR(v.y, std::sin(angle), 1e-14);
  }
}

TEST(AgentShapes, CloserThanAgreesWithTheDistanceOfTheSides) {
  std::mt19937_64 draws(1);
  std::uniform_real_distribution<double> place(-3.0, 3.0), angle(-4.0, 4.0), size(0.2, 3.0);
  int near = 0;
  for (int i = 0; i < 20'000; ++i) {
    const fp_pose a = pose(place(draws), place(draws), angle(draws)),
                  b = pose(place(draws), place(draws), angle(draws));
    const double la = size(draws), wa = size(draws), lb = size(draws), wb = size(draws);
    const double clear_m = testing::clearance_m(testing::corners(a, la, wa), testing::corners(b, lb, wb));
    EXPECT_EQ(closer_than(body(a, la, wa), body(b, lb, wb), clear_m + 1e-9), true);
    if (clear_m > 1e-9) {
      EXPECT_EQ(closer_than(body(a, la, wa), body(b, lb, wb), clear_m - 1e-9), false) << i;
      ++near;
    }
  }
  EXPECT_GT(near, 5000);
}

// The corners of a body whose reference point is at the pose.
auto corners_of(fp_pose reference, bool tail_first, const Body& body) {
  const double nose = tail_first ? -1.0 : 1.0;
  reference.heading_x *= nose, reference.heading_y *= nose;
  reference.x_m += body.ahead_m * reference.heading_x, reference.y_m += body.ahead_m * reference.heading_y;
  return testing::corners(reference, body.length_m, body.width_m);
}

// Whatever the body covers at any point of the arc, nose first or tail first, the shapes cover; and not much more.
TEST(AgentShapes, SweepCoversTheBodyEverywhereOnTheArc) {
  std::mt19937_64 draws(2);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < 120; ++i) {
    const double radius_m = 0.8 + 4.0 * unit(draws), angle = 0.05 + 3.0 * unit(draws);
    const fp_arc arc{pose(5.0 * unit(draws), 5.0 * unit(draws), 6.3 * unit(draws)), i % 6 == 0 ? 4.0 : radius_m * angle,
                     i % 6 == 0 ? 0.0 : (i % 2 == 0 ? 1.0 : -1.0) / radius_m};
    const Body body{1.0 + 1.6 * unit(draws), 0.6 + 0.7 * unit(draws), i < 60 ? 0.0 : unit(draws) - 0.5};
    const bool tail_first = i % 4 >= 2;
    std::vector<Shape> shapes;
    append_sweep(arc, tail_first, body, shapes);
    double widest_m = 0.0;
    for (const Shape& s : shapes) widest_m = std::max(widest_m, s.half_width_m - body.width_m / 2.0);
    EXPECT_LT(widest_m, 0.08 + 0.06 * std::abs(body.ahead_m));
    for (double t = 0.0; t <= 1.0; t += 1.0 / 512) {
      for (const auto& corner : corners_of(testing::on_arc(arc, t * arc.length_m), tail_first, body)) {
        double nearest_m = 1e9;
        for (const Shape& s : shapes) nearest_m = std::min(nearest_m, distance_m({corner.x, corner.y}, s));
        ASSERT_LE(nearest_m, 1e-9) << "arc " << i << " at " << t;
      }
    }
  }
}

// The same while the body turns on the spot, also by a little more than asked for.
TEST(AgentShapes, TurnCoversTheBodyAtEveryHeading) {
  std::mt19937_64 draws(4);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < 400; ++i) {
    const double from = 6.3 * unit(draws), most = i % 4 == 0 ? 0.05 : 2.3;
    const double to = from + (i % 2 == 0 ? 1.0 : -1.0) * (0.0015 + most * unit(draws));
    const fp_pose start = pose(5.0 * unit(draws), 5.0 * unit(draws), from);
    const Body body{1.0 + 1.6 * unit(draws), 0.6 + 0.7 * unit(draws), i < 200 ? 0.0 : 2.0 * unit(draws) - 1.0};
    std::vector<Shape> shapes;
    append_turn({start.x_m, start.y_m}, {std::cos(from), std::sin(from)}, {std::cos(to), std::sin(to)}, body, shapes);
    EXPECT_LE(shapes.size(), kMostTurnPieces);
    for (const Shape& s : shapes)
      EXPECT_LT(s.half_width_m - body.width_m / 2.0, 0.052 * (body.length_m / 2.0 + std::abs(body.ahead_m)));
    const double beyond = to > from ? 0.0014 : -0.0014;
    for (double t = 0.0; t <= 1.0; t += 1.0 / 512) {
      const double angle = from - beyond + t * (to - from + 2.0 * beyond);
      for (const auto& corner : corners_of(pose(start.x_m, start.y_m, angle), false, body)) {
        double nearest_m = 1e9;
        for (const Shape& s : shapes) nearest_m = std::min(nearest_m, distance_m({corner.x, corner.y}, s));
        ASSERT_LE(nearest_m, 1e-9) << "turn " << i << " at " << t;
      }
    }
  }
}

TEST(AgentShapes, EndOfAnArcIsWhereItLeads) {
  const fp_arc arc{pose(1.0, 2.0, 0.7), 3.0, -0.6};
  const fp_pose end = end_of(arc), expected = testing::on_arc(arc, 3.0);
  EXPECT_NEAR(end.x_m, expected.x_m, 1e-12);
  EXPECT_NEAR(end.y_m, expected.y_m, 1e-12);
  EXPECT_NEAR(end.heading_x, expected.heading_x, 1e-12);
  EXPECT_NEAR(end.heading_y, expected.heading_y, 1e-12);
}

class Crossing : public ::testing::Test {
 protected:
  // Two lanes that cross without a common station, and a third beside them at 1.15 m: bodies 1 m wide pass with 0.15 m.
  static DrawnMap draw() {
    DrawnMap d;
    for (const auto& [x, y] : {std::pair(-4.0, 0.0), {4.0, 0.0}, {0.0, -4.0}, {0.0, 4.0}, {-4.0, 1.15}, {4.0, 1.15}})
      d.station(x, y);
    for (const std::uint32_t from : {0U, 2U, 4U}) d.segment(from, from + 1);
    return d;
  }

  Path path(std::uint32_t from, std::uint32_t to) {
    Path p;
    p.station = from;
    const std::uint32_t lane = drawn.lane_between(from, to);
    p.heading = {drawn.lane_at(lane).arcs[0].start.heading_x, drawn.lane_at(lane).arcs[0].start.heading_y};
    p.append(lane);
    return p;
  }

  DrawnMap drawn = draw();
  TestFleet fleet{drawn.map(), 2};
  MapView map{drawn.map()};
  HullGeometry geometry{map, fleet.briefing(0, 0)};
};

TEST_F(Crossing, LanesConflictWhereverTheyMeet) {
  EXPECT_TRUE(geometry.conflict(0, path(0, 1), 1, path(2, 3)));
  EXPECT_TRUE(geometry.conflict(0, path(0, 1), 1, path(1, 0))) << "both ways of one segment";
  EXPECT_FALSE(geometry.conflict(0, path(0, 1), 1, path(4, 5))) << "0.15 m beside it";
}

TEST_F(Crossing, TurningOnTheSpotNeedsMoreRoomThanDrivingOff) {
  Path turning = path(0, 1);
  turning.heading = {0.0, 1.0};
  EXPECT_TRUE(geometry.conflict(0, turning, 1, path(4, 5)));
}

TEST_F(Crossing, TurnNeedsNoFloorThatItDoesNotSweep) {
  // A lane to the east, and a little to the left of it the lane after it. 0.85 m to the right of them, another body.
  DrawnMap kinked;
  const std::uint32_t at = kinked.station(0, 0);
  kinked.segment(kinked.station(-6, 0), at), kinked.segment(at, kinked.station(6, 1));
  kinked.station(-0.6, -1.35);
  const MapView view(kinked.map());
  const TestFleet pair(kinked.map(), 2);
  HullGeometry hulls(view, pair.briefing(0, 0));
  Path through, back, beside;
  through.station = 1;
  through.append(kinked.lane_between(1, at)), through.append(kinked.lane_between(at, 2));
  back.station = 1;
  back.append(kinked.lane_between(1, at)), back.append(kinked.lane_between(at, 1));
  beside.station = 3;
  EXPECT_FALSE(hulls.conflict(0, through, 1, beside)) << "a turn of nine degrees";
  EXPECT_TRUE(hulls.conflict(0, back, 1, beside)) << "half a turn may go either way";
}

// Two AGVs of two kinds, each of which turns at its station and drives a little, or stands.
class Turning : public ::testing::Test {
 protected:
  struct Agv {
    double x, y, from, turn;
    Body body;
  };

  double unit() { return std::uniform_real_distribution<double>(0.0, 1.0)(draws); }
  Agv any(double away_m, const Body& body) {
    const double side = 6.3 * unit(), turn = unit() < 0.3 ? 0.0 : (unit() < 0.5 ? 1.0 : -1.0) * (0.02 + 3.1 * unit());
    return {away_m * std::cos(side), away_m * std::sin(side), 6.3 * unit(), turn, body};
  }
  static constexpr double kDriven_m = 0.3;

  // The corners of the body at many instants, from the turn to the end of the lane.
  static auto sweep_of(const Agv& agv) {
    std::vector<decltype(corners_of(fp_pose{}, false, agv.body))> sweep;
    const double last = agv.from + agv.turn;
    for (double t = 0.0; t <= 1.0; t += 1.0 / 64)
      sweep.push_back(corners_of(pose(agv.x, agv.y, agv.from + t * agv.turn), false, agv.body));
    if (agv.turn == 0.0) return sweep;
    for (double on_m = 0.0; on_m <= kDriven_m; on_m += kDriven_m / 4)
      sweep.push_back(
          corners_of(pose(agv.x + on_m * std::cos(last), agv.y + on_m * std::sin(last), last), false, agv.body));
    return sweep;
  }

  // Of its station, with lanes that give both headings.
  static Path add_to(DrawnMap& drawn, const Agv& agv) {
    const double last = agv.from + agv.turn;
    Path path;
    path.station = drawn.station(agv.x, agv.y);
    path.heading = {std::cos(agv.from), std::sin(agv.from)};
    drawn.segment(drawn.station(agv.x - 9.0 * std::cos(agv.from), agv.y - 9.0 * std::sin(agv.from)), path.station);
    const auto to = drawn.station(agv.x + kDriven_m * std::cos(last), agv.y + kDriven_m * std::sin(last));
    drawn.segment(path.station, to);
    if (agv.turn != 0.0) path.append(drawn.lane_between(path.station, to));
    return path;
  }

  static fp_agv with(const Body& body) {
    fp_agv agv = testing::kTestAgv;
    agv.length_m = agv.loaded_length_m = body.length_m, agv.width_m = agv.loaded_width_m = body.width_m;
    agv.centre_ahead_m = body.ahead_m;
    return agv;
  }

  std::mt19937_64 draws{5};
};

// The oracle: the clearance between the bodies at many instants of both motions.
TEST_F(Turning, AgvsConflictIfTheirBodiesComeClose) {
  int conflicts = 0, free = 0, close = 0;
  for (int i = 0; i < 1500; ++i) {
    const Agv agvs[2] = {any(0.0, {1.2, 0.8, 0.0}), any(1.2 + 2.4 * unit(), {2.8, 1.0, 1.4 * unit() - 0.7})};
    DrawnMap drawn;
    const Path paths[2] = {add_to(drawn, agvs[0]), add_to(drawn, agvs[1])};
    TestFleet fleet(drawn.map(), 2, with(agvs[0].body));
    fleet.agvs[1] = with(agvs[1].body);
    const MapView map(drawn.map());
    HullGeometry geometry(map, fleet.briefing(0, 0));
    double nearest_m = INFINITY;
    const auto second = sweep_of(agvs[1]);
    for (const auto& first : sweep_of(agvs[0])) {
      for (const auto& other : second) nearest_m = std::min(nearest_m, testing::clearance_m(first, other));
    }
    const bool found = geometry.conflict(0, paths[0], 1, paths[1]);
    EXPECT_EQ(geometry.conflict(1, paths[1], 0, paths[0]), found) << i;
    const bool sectors_only = std::abs(agvs[0].turn) < 2.3 && std::abs(agvs[1].turn) < 2.3;
    if (nearest_m < geometry.clearance_m()) {
      EXPECT_TRUE(found) << i << ": " << nearest_m;
    } else if (sectors_only && nearest_m > geometry.clearance_m() + 0.16) {
      EXPECT_FALSE(found) << i << ": " << nearest_m;
    }
    conflicts += found, free += !found;
    close += std::abs(nearest_m - geometry.clearance_m()) < 0.1;
  }
  EXPECT_GT(conflicts, 400);
  EXPECT_GT(free, 200);
  EXPECT_GT(close, 100);
}

TEST_F(Crossing, StandingAgvHoldsItsBody) {
  Path standing;
  standing.station = 0;
  standing.heading = {1.0, 0.0};
  EXPECT_TRUE(geometry.conflict(0, standing, 1, path(1, 0)));
  EXPECT_FALSE(geometry.conflict(0, standing, 1, path(2, 3)));
  EXPECT_FALSE(geometry.conflict(0, standing, 1, path(4, 5)));
  standing.heading = {0.0, 1.0};
  EXPECT_TRUE(geometry.conflict(0, standing, 1, path(4, 5)));
}

// The map gives arcs whose heading is right to 2 mrad: the end of a long body lies that much further aside.
TEST_F(Crossing, LongBodiesKeepMoreDistance) {
  EXPECT_DOUBLE_EQ(geometry.clearance_m(), 0.10 + kHullTolerance_m);
  fp_agv train = testing::kTestAgv;
  train.length_m = train.loaded_length_m = 20.0;
  fp_agv tug = testing::kTestAgv;
  tug.centre_ahead_m = -12.0;
  for (const auto& [agv, reach_m] : {std::pair(train, 10.0), {tug, 12.0}}) {
    const TestFleet two(drawn.map(), 2, agv);
    EXPECT_GE(HullGeometry(map, two.briefing(0, 0)).clearance_m(), 0.10 + 2.0 * 2e-3 * reach_m);
  }
}

TEST_F(Crossing, TheSafetyDistanceCountsEverywhere) {
  // Bodies 1 m wide beside each other, the centres 1.08 m or 1.15 m apart: 0.08 m is too near, driving or standing.
  for (const auto& [y_m, conflict] : {std::pair(1.08, true), {1.15, false}}) {
    DrawnMap beside;
    for (const double y : {0.0, y_m}) beside.station(-4, y), beside.station(4, y);
    beside.segment(0, 1), beside.segment(2, 3);
    const MapView view(beside.map());
    const TestFleet pair(beside.map(), 2);
    HullGeometry hulls(view, pair.briefing(0, 0));
    Path driving, standing, other;
    driving.station = 0, standing.station = 0, other.station = 2;
    EXPECT_EQ(hulls.conflict(0, standing, 1, other), conflict);
    driving.append(beside.lane_between(0, 1));
    EXPECT_EQ(hulls.conflict(0, driving, 1, other), conflict);
    EXPECT_EQ(hulls.conflict(1, other, 0, driving), conflict);
    other.append(beside.lane_between(2, 3));
    EXPECT_EQ(hulls.conflict(0, driving, 1, other), conflict);
  }
}

// The oracle: the sweeps themselves, without the discs that rule out pairs far from each other.
TEST(HullGeometry, DrawnLanesConflictIfTheirSweepsDo) {
  std::mt19937_64 draws(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  DrawnMap drawn;
  for (std::uint32_t i = 0; i < 80; ++i) {
    const double angle = 2.0 * M_PI * unit(draws), curvature_per_m = i % 2 == 0 ? 0.0 : 0.8 * (unit(draws) - 0.5);
    const double length_m = 1.0 + 7.0 * unit(draws);
    const std::uint32_t from = drawn.station(20.0 * unit(draws), 20.0 * unit(draws));
    const fp_pose end = end_of(
        fp_arc{pose(drawn.map().stations[from].x_m, drawn.map().stations[from].y_m, angle), length_m, curvature_per_m});
    drawn.bend(from, drawn.station(end.x_m, end.y_m), std::cos(angle), std::sin(angle), length_m, curvature_per_m);
  }
  const TestFleet fleet(drawn.map(), 2);
  const MapView map(drawn.map());
  HullGeometry geometry(map, fleet.briefing(0, 0));
  const auto sweep = [&](std::uint32_t lane) {
    std::vector<Shape> shapes;
    append_sweep(map.arc(map.lane(lane), 0), false, {testing::kTestAgv.length_m, testing::kTestAgv.width_m}, shapes);
    return shapes;
  };
  int conflicts = 0;
  for (int round = 0; round < 2; ++round) {  // what is remembered is the same
    for (std::uint32_t a = 0; a < map.lane_count(); ++a) {
      for (std::uint32_t b = 0; b < map.lane_count(); ++b) {
        bool found = false;
        for (const Shape& of_a : sweep(a)) {
          for (const Shape& of_b : sweep(b)) found = found || closer_than(of_a, of_b, 0.12);
        }
        Path other;
        other.station = map.lane(b).from;
        other.heading = map.start_heading(b);
        other.append(b);
        ASSERT_EQ(geometry.lane_conflict(0, a, 1, other), found) << a << " and " << b;
        conflicts += found;
      }
    }
  }
  EXPECT_GT(conflicts, 1000);
}

TEST_F(Crossing, DistanceBoundIsNoMoreThanTheDistance) {
  const Path p = path(0, 1);
  for (double x = -20.0; x < 20.0; x += 1.7) {
    const double true_m = std::max(0.0, std::hypot(std::max(std::abs(x) - 4.8, 0.0), 9.5));
    EXPECT_LE(geometry.distance_bound_m({x, 10.0}, 0, p), true_m + 1e-9);
  }
  EXPECT_GT(geometry.distance_bound_m({30.0, 0.0}, 0, p), 24.0);
}

}  // namespace
}  // namespace fleetproof::agents::hull_test
