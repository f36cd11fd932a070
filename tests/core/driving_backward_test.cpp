// Lanes that are driven tail first, and what the plant does not allow.
#include <gtest/gtest.h>

#include <functional>

#include "core/engine/simulation.hpp"
#include "tests/core/small_world.hpp"

namespace fleetproof::driving_backward_test {
namespace {

using test::kFirst;

// Two stations 10 m apart on a line along x, and one 10 m to the left of the second.
Layout corner() {
  Layout layout;
  layout.name = "corner";
  layout.stations = {{"a", {0.0, 0.0}}, {"b", {10.0, 0.0}}, {"c", {10.0, 10.0}}};
  layout.segments.push_back({"a-b", StationId{0U}, StationId{1U}, true});
  layout.segments.push_back({"b-c", StationId{1U}, StationId{2U}, true});
  layout.floor_low_m = {-5.0, -5.0};
  layout.floor_high_m = {15.0, 15.0};
  return layout;
}

Scenario scenario_on(const Layout& layout) {
  Scenario scenario = test::row_scenario(4, {0}, 60.0);
  scenario.map = std::make_shared<const LogicalMap>(layout);
  return scenario;
}

// What one controller call after the other returns; each next one is made when the action before it is done. Then where
// the AGV stands.
struct Driven {
  std::vector<std::int32_t> answers;
  std::vector<double> done_s;
  fp_pose stands{};
  Outcome outcome;
};

struct Call {
  fp_call call;
  std::uint32_t segment;
};

Driven drive(const Scenario& scenario, const std::vector<Call>& calls) {
  Driven driven;
  std::size_t next = 0;
  driven.outcome = test::simulate_with(
      scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& event) {
        if (event.kind == FP_EVENT_ACTION_DONE) driven.done_s.push_back(static_cast<double>(event.now_ns) * 1e-9);
        const bool begins = event.kind == (scenario.agvs[0].transports.empty() ? FP_EVENT_START : FP_EVENT_ORDER);
        if (!begins && event.kind != FP_EVENT_ACTION_DONE) return;
        host.get_position(c, &driven.stands);
        while (next < calls.size()) {
          const auto [call, segment] = calls[next++];
          const auto action = call == FP_CALL_MOVE ? host.move : call == FP_CALL_PARK ? host.park : host.pick;
          driven.answers.push_back(action(c, segment));
          if (driven.answers.back() == FP_OK) return;
        }
      });
  return driven;
}

TEST(DrivingBackward, KeepsTheNoseAndNeedsNoTurn) {
  Layout layout = corner();
  layout.segments[0].back_travel = Travel::Backward;
  const Driven driven = drive(scenario_on(layout), {{FP_CALL_MOVE, 0}, {FP_CALL_MOVE, 0}});
  EXPECT_EQ(driven.answers, (std::vector<std::int32_t>{FP_OK, FP_OK}));
  EXPECT_EQ(driven.outcome.counters.turns, 0U);
  ASSERT_EQ(driven.done_s.size(), 2U);
  EXPECT_NEAR(driven.done_s[1], 16.0, 1e-9) << "8 s there and 8 s back";
  EXPECT_NEAR(driven.stands.x_m, 0.0, 1e-12);
  EXPECT_EQ(driven.stands.heading_x, 1.0) << "the nose still points along x";
}

TEST(DrivingBackward, EitherWayIsForTheAgentToChoose) {
  Layout layout = corner();
  layout.segments[0].travel = Travel::Either;
  const Scenario scenario = scenario_on(layout);
  EXPECT_EQ(scenario.map->lanes().size(), 5U);
  const Driven forward = drive(scenario, {{FP_CALL_MOVE, 0}});
  EXPECT_EQ(forward.outcome.counters.turns, 0U);
  EXPECT_EQ(forward.stands.heading_x, 1.0);
  const Driven backward = drive(scenario, {{FP_CALL_MOVE, 0 | FP_BACKWARD}});
  EXPECT_EQ(backward.outcome.counters.turns, 1U) << "it turns its tail to the way first";
  EXPECT_NEAR(backward.stands.x_m, 10.0, 1e-12);
  EXPECT_EQ(backward.stands.heading_x, -1.0);
  EXPECT_NE(forward.outcome.digest, backward.outcome.digest);
  const Driven no_way = drive(scenario, {{FP_CALL_MOVE, 0}, {FP_CALL_MOVE, 0 | FP_BACKWARD}, {FP_CALL_MOVE, 99}});
  EXPECT_EQ(no_way.answers, (std::vector<std::int32_t>{FP_OK, FP_REFUSED, FP_INVALID})) << "back is forward only";
}

TEST(DrivingBackward, HasATopSpeedOfItsOwn) {
  Layout layout = corner();
  layout.segments[0].back_travel = Travel::Backward;
  Scenario scenario = scenario_on(layout);
  scenario.vehicle_types[0].reverse_speed_mps = 0.5;
  const Driven driven = drive(scenario, {{FP_CALL_MOVE, 0}, {FP_CALL_MOVE, 0}});
  ASSERT_EQ(driven.done_s.size(), 2U);
  // 1 s and 0.25 m up, 0.5 s and 0.125 m down, 9.625 m at 0.5 m/s.
  EXPECT_NEAR(driven.done_s[1] - driven.done_s[0], 1.0 + 0.5 + 19.25, 1e-9);
}

// A drive tail first at 0.5 m/s, against a drive nose first of a vehicle that is as fast forward.
struct Direction {
  Travel travel;
  double forward_mps, reverse_mps;
};
constexpr Direction kTailFirst{Travel::Backward, 2.0, 0.5}, kQuickTailFirst{Travel::Backward, 0.1, 0.5},
    kNoseFirst{Travel::Forward, 0.5, 0.0};

// When the drive from the first station to the second ends, with or without a load.
double arrives_s(const Direction& direction, bool loaded, const std::function<void(Scenario&, Layout&)>& change) {
  Layout layout = corner();
  layout.segments[0].travel = direction.travel;
  Scenario scenario = scenario_on(layout);
  VehicleType& type = scenario.vehicle_types[0];
  type.drive.speed_mps = direction.forward_mps;
  type.reverse_speed_mps = direction.reverse_mps;
  if (direction.travel == Travel::Backward) scenario.agvs[0].heading = {-1.0, 0.0};
  scenario.horizon = seconds(400.0);
  if (loaded) scenario.agvs[0].transports = {{StationId{0U}, StationId{1U}, Duration{}}};
  change(scenario, layout);
  scenario.map = std::make_shared<const LogicalMap>(layout);
  const Driven driven =
      loaded ? drive(scenario, {{FP_CALL_PICK, FP_HERE}, {FP_CALL_MOVE, 0}}) : drive(scenario, {{FP_CALL_MOVE, 0}});
  return driven.done_s.empty() ? -1.0 : driven.done_s.back();
}

// What holds for the one direction holds for the other, also if the vehicle is faster backward than forward.
void expect_as_nose_first(bool loaded, const std::function<void(Scenario&, Layout&)>& change) {
  const double nose_first_s = arrives_s(kNoseFirst, loaded, change);
  EXPECT_GT(nose_first_s, 0.0);
  EXPECT_NE(nose_first_s, arrives_s(kNoseFirst, loaded, [](Scenario&, Layout&) {})) << "the change slows it";
  EXPECT_EQ(arrives_s(kTailFirst, loaded, change), nose_first_s);
  EXPECT_EQ(arrives_s(kQuickTailFirst, loaded, change), nose_first_s);
}

TEST(DrivingBackward, MayBeFasterThanForward) {
  EXPECT_NEAR(arrives_s(kQuickTailFirst, false, [](Scenario&, Layout&) {}), 1.0 + 0.5 + 19.25, 1e-9);
}

TEST(DrivingBackward, IsSlowedByALoad) {
  expect_as_nose_first(true, [](Scenario& scenario, Layout&) { scenario.vehicle_types[0].loaded.speed_share = 0.5; });
  expect_as_nose_first(true,
                       [](Scenario& scenario, Layout&) { scenario.vehicle_types[0].loaded.acceleration_share = 0.5; });
}

TEST(DrivingBackward, IsFasterOrSlowerByTheDeviation) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    expect_as_nose_first(false, [&](Scenario& scenario, Layout&) {
      scenario.seed = seed;
      scenario.vehicle_types[0].speed_deviation = 0.3;
    });
  }
}

TEST(DrivingBackward, KeepsTheLimitOfTheLaneAndOfBends) {
  expect_as_nose_first(false, [](Scenario&, Layout& layout) { layout.segments[0].speed_limit_mps = 0.2; });
  expect_as_nose_first(false, [](Scenario& scenario, Layout& layout) {
    layout.segments[0].control_points_m = {{4.0, 2.0}, {6.0, -2.0}};
    for (Station& station : layout.stations) station.turning = true;
    scenario.vehicle_types[0].lateral_mps2 = 0.01;
  });
}

// A vehicle that rolls through a station enters the next lane at the speed of its direction.
TEST(DrivingBackward, RollsThroughStationsAtItsOwnSpeed) {
  const auto rolls = [](const Direction& direction) {
    Layout layout = corner();
    layout.stations[2].position_m = {20.0, 0.0};
    for (Segment& segment : layout.segments) segment.travel = direction.travel;
    Scenario scenario = scenario_on(layout);
    scenario.vehicle_types[0].drive.speed_mps = direction.forward_mps;
    scenario.vehicle_types[0].reverse_speed_mps = direction.reverse_mps;
    if (direction.travel == Travel::Backward) scenario.agvs[0].heading = {-1.0, 0.0};
    std::vector<double> done_s;
    std::size_t moves = 0;
    test::simulate_with(scenario,
                        [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& event) {
                          if (event.kind == FP_EVENT_ACTION_DONE)
                            done_s.push_back(static_cast<double>(event.now_ns) * 1e-9);
                          if (event.kind != FP_EVENT_START || moves++ > 0) return;
                          EXPECT_EQ(host.move(c, 0), FP_OK);
                          EXPECT_EQ(host.move(c, 1), FP_OK);
                        });
    return done_s;
  };
  const std::vector<double> nose_first_s = rolls(kNoseFirst);
  EXPECT_EQ(nose_first_s.size(), 2U);
  EXPECT_EQ(rolls(kTailFirst), nose_first_s);
  EXPECT_EQ(rolls(kQuickTailFirst), nose_first_s);
}

TEST(DrivingBackward, StopsWhereTheOtherEndGoesFirst) {
  Layout layout = corner();
  layout.stations[2].position_m = {20.0, 0.0};
  layout.segments[1].travel = Travel::Either;
  const auto both = [&](std::uint32_t second) {
    Driven driven;
    std::size_t moves = 0;
    driven.outcome = test::simulate_with(
        scenario_on(layout), [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& event) {
          if (event.kind == FP_EVENT_ACTION_DONE) driven.done_s.push_back(static_cast<double>(event.now_ns) * 1e-9);
          if (event.kind != FP_EVENT_START || moves++ > 0) return;
          EXPECT_EQ(host.move(c, 0), FP_OK);
          EXPECT_EQ(host.move(c, second), FP_OK);
        });
    return driven;
  };
  EXPECT_EQ(both(1).outcome.counters.rolls, 1U);
  EXPECT_EQ(both(1 | FP_BACKWARD).outcome.counters.rolls, 0U);
  EXPECT_EQ(both(1 | FP_BACKWARD).outcome.counters.turns, 1U);
}

TEST(ABodyWhoseCentreIsAhead, TurnsAboutItsReferencePoint) {
  Scenario scenario = scenario_on(corner());
  scenario.vehicle_types[0].footprint = {2.0, 1.0, 0.75};
  scenario.agvs[0].start = StationId{1U};
  test::SmallWorld world(scenario);
  const auto middle = [&] {
    const auto& piece = world.run.world.body(kFirst).piece;
    return piece.body_at(world.run.now).centre_m;
  };
  EXPECT_NEAR((middle() - Vec2(10.75, 0.0)).norm(), 0.0, 1e-12);
  test::started(world);
  ASSERT_TRUE(world.parts.actions.accept(kFirst, FP_CALL_MOVE, 1));
  world.parts.actions.begin(kFirst, FP_CALL_MOVE, 1);
  world.run.now = world.run.status(kFirst).activity->end;
  world.parts.actions.activity_ends(kFirst);
  EXPECT_NEAR((middle() - Vec2(10.0, 0.75)).norm(), 0.0, 1e-9) << "turned to the left about the station";
}

TEST(PlantRules, PermissionsAreByTypeAndLoad) {
  Layout layout = corner();
  layout.segments[0].permissions = {{"tugger", LoadState::Any}};
  Scenario scenario = scenario_on(layout);
  EXPECT_EQ(drive(scenario, {{FP_CALL_MOVE, 0}}).answers, std::vector<std::int32_t>{FP_REFUSED});
  scenario.vehicle_types[0].name = "tugger";
  EXPECT_EQ(drive(scenario, {{FP_CALL_MOVE, 0}}).answers, std::vector<std::int32_t>{FP_OK});
  layout.segments[0].permissions = {{"", LoadState::Loaded}, {"other", LoadState::Any}};
  scenario.map = std::make_shared<const LogicalMap>(layout);
  scenario.agvs[0].transports = {{StationId{0U}, StationId{1U}, Duration{}}};
  const Driven loaded = drive(scenario, {{FP_CALL_MOVE, 0}, {FP_CALL_PICK, FP_HERE}, {FP_CALL_MOVE, 0}});
  EXPECT_EQ(loaded.answers, (std::vector<std::int32_t>{FP_REFUSED, FP_OK, FP_OK})) << "with a load alone";
}

TEST(PlantRules, WhereTurningIsForbiddenOnlyTheWayStraightOnIsLeft) {
  Layout layout = corner();
  layout.stations[1].turning = false;
  layout.segments[0].back_travel = Travel::Backward;
  const Driven driven = drive(scenario_on(layout), {{FP_CALL_MOVE, 0}, {FP_CALL_MOVE, 1}, {FP_CALL_MOVE, 0}});
  EXPECT_EQ(driven.answers, (std::vector<std::int32_t>{FP_OK, FP_REFUSED, FP_OK})) << "no turn to the left; back again";
}

TEST(PlantRules, AStationMayAskForAHeading) {
  Layout layout = corner();
  layout.segments[0].travel = Travel::Either;
  layout.stations[1].heading = Vec2(-1.0, 0.0);
  const Scenario scenario = scenario_on(layout);
  EXPECT_EQ(drive(scenario, {{FP_CALL_PARK, 0}, {FP_CALL_PARK, 0 | FP_BACKWARD}}).answers,
            (std::vector<std::int32_t>{FP_REFUSED, FP_OK}));
  EXPECT_EQ(drive(scenario, {{FP_CALL_MOVE, 0}, {FP_CALL_PARK, FP_HERE}}).answers,
            (std::vector<std::int32_t>{FP_OK, FP_REFUSED}));
}

TEST(PlantRules, AgentsAreToldOfThem) {
  Layout layout = corner();
  layout.segments[0].travel = Travel::Either;
  layout.segments[0].permissions = {{"tugger", LoadState::Empty}, {"nobody", LoadState::Any}};
  layout.stations[1].turning = false;
  layout.stations[2].heading = Vec2(0.0, 1.0);
  Scenario scenario = scenario_on(layout);
  scenario.vehicle_types[0].name = "tugger";
  scenario.vehicle_types[0].footprint.centre_ahead_m = 0.25;
  scenario.vehicle_types[0].reverse_speed_mps = 0.75;
  test::simulate_with(scenario, [&](const fp_host&, fp_controller*, const fp_briefing& b, const fp_event&) {
    const fp_map& map = *b.map;
    ASSERT_EQ(map.lane_count, 5U);
    EXPECT_EQ(map.lanes[0].backward, 0U);
    EXPECT_EQ(map.lanes[1].backward, 1U);
    EXPECT_EQ(map.lanes[1].segment, 0U);
    EXPECT_EQ(map.lanes[1].arcs[0].start.heading_x, 1.0) << "the way of the reference point";
    ASSERT_EQ(map.lanes[0].permission_count, 2U);
    EXPECT_EQ(map.lanes[0].permissions[0].vehicle_type, 0U);
    EXPECT_EQ(map.lanes[0].permissions[0].load, static_cast<std::uint32_t>(FP_EMPTY_ONLY));
    EXPECT_EQ(map.lanes[0].permissions[1].vehicle_type, 1U) << "no AGV of this fleet";
    EXPECT_EQ(map.stations[1].turning_forbidden, 1U);
    EXPECT_EQ(map.stations[0].turning_forbidden, 0U);
    EXPECT_EQ(map.stations[2].heading_y, 1.0);
    EXPECT_EQ(map.stations[0].heading_x, 0.0);
    EXPECT_EQ(b.fleet[0].vehicle_type, 0U);
    EXPECT_EQ(b.fleet[0].centre_ahead_m, 0.25);
    EXPECT_EQ(b.fleet[0].reverse_speed_mps, 0.75);
  });
}

}  // namespace
}  // namespace fleetproof::driving_backward_test
