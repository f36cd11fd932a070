#include "core/engine/operator_actions.hpp"

#include <gtest/gtest.h>

#include "tests/core/small_world.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof::operator_actions_test {
namespace {

using test::kFirst;
using test::kSecond;
using test::SmallWorld;
using test::started;

Scenario with_operator(std::vector<std::uint32_t> starts) {
  Scenario scenario = test::row_of_tens(std::move(starts));
  scenario.operator_help = {.on = true, .least_s = 60.0, .most_s = 300.0, .battery = 0.8};
  return scenario;
}

Event help_comes(SmallWorld& world) {
  const Event event = world.next(Event::Kind::OperatorComes);
  world.parts.operator_actions.comes(event.entity, static_cast<Assist>(event.payload), event.stamp);
  return event;
}

TEST(OperatorActionsPart, ComesWithinItsTimesAndOnlyIfThereIsOne) {
  SmallWorld world(with_operator({0})), nobody(test::row_of_tens({0}));
  nobody.parts.operator_actions.call(kFirst, Assist::Battery, 1);
  EXPECT_TRUE(nobody.run.queue.empty());
  for (int i = 0; i < 50; ++i) world.parts.operator_actions.call(kFirst, Assist::Battery, 1);
  double earliest_s = 1000.0, latest_s = 0.0;
  for (int i = 0; i < 50; ++i) {
    const double at_s = to_seconds(world.next(Event::Kind::OperatorComes).at);
    earliest_s = std::min(earliest_s, at_s);
    latest_s = std::max(latest_s, at_s);
  }
  EXPECT_TRUE(earliest_s >= 60.0 && latest_s <= 300.0);
  EXPECT_TRUE(earliest_s < 90.0 && latest_s > 270.0) << "50 draws come near both ends";
}

TEST(OperatorActionsPart, HelpsWithTheHaltItWasCalledFor) {
  SmallWorld world(with_operator({0}));
  const std::uint64_t halt = world.parts.halts.begin(kFirst, Halt::Reason::EmptyBattery);
  world.parts.operator_actions.call(kFirst, Assist::Battery, halt);
  help_comes(world);
  EXPECT_TRUE(world.run.status(kFirst).halts.empty());
  EXPECT_DOUBLE_EQ(world.parts.battery.level(kFirst), 0.8);
  EXPECT_EQ(world.run.counters.assists, 1U);
}

TEST(OperatorActionsPart, DoesNothingAboutAHaltThatIsOver) {
  SmallWorld world(with_operator({0}));
  const std::uint64_t halt = world.parts.halts.begin(kFirst, Halt::Reason::Scanner);
  world.parts.operator_actions.call(kFirst, Assist::Jam, halt);
  world.parts.halts.end(kFirst, halt);
  world.parts.halts.begin(kFirst, Halt::Reason::Scanner);
  help_comes(world);
  EXPECT_EQ(world.run.status(kFirst).halts.size(), 1U);
  EXPECT_EQ(world.run.counters.assists, 0U);
}

TEST(OperatorActionsPart, TakesAnAgvOffTheFloorAndSetsItDownAtItsStation) {
  SmallWorld world(with_operator({0, 2}));
  started(world);
  world.parts.halts.begin(kFirst, Halt::Reason::Scanner);
  world.parts.actions.stop_for_good(kFirst);
  world.parts.operator_actions.call(kFirst, Assist::Contact, 0);
  help_comes(world);
  EXPECT_FALSE(world.run.world.body(kFirst).on_floor);
  EXPECT_TRUE(world.run.status(kFirst).halts.empty());
  EXPECT_FALSE(world.parts.agents.is_up(kFirst));
  world.next(Event::Kind::BodyAppears);
  world.parts.operator_actions.look_for_place(kFirst);
  EXPECT_TRUE(world.run.world.body(kFirst).on_floor);
  EXPECT_NEAR(world.x_m(kFirst), 0.0, 1e-9);
  EXPECT_FALSE(world.run.status(kFirst).out_of_order);
  EXPECT_TRUE(world.parts.agents.is_up(kFirst));
}

TEST(OperatorActionsPart, RestartsAnAgentAtAStandstillAndNotWhileWorkIsUnderWay) {
  Scenario scenario = with_operator({0, 2});
  scenario.agvs[1].transports = {{StationId{2U}, StationId{3U}, Duration{}}};
  SmallWorld world(scenario);
  started(world).parts.agents.order_released(TransportId{0U});
  world.clock(130.0);
  world.run.status(kFirst).activity = world.drive_activity(kFirst, world.lane(0, 0));
  world.parts.operator_actions.looks();
  EXPECT_FALSE(world.has(Event::Kind::OperatorComes)) << "an AGV drives";
  world.run.status(kFirst).activity.reset();
  world.clock(251.0);
  world.parts.operator_actions.looks();
  EXPECT_EQ(help_comes(world).entity, kSecond) << "whose transport is open";
  EXPECT_EQ(world.run.counters.assists, 1U);
  EXPECT_EQ(world.trace.of(TraceKind::OperatorAssists).at(0).a, static_cast<std::uint64_t>(Assist::Standstill));
}

// All places, in order of preference: none suits.
std::vector<RecoveryPlace> recovery_places(const LaneRules& rules, StationId station, const Lane* stopped_on,
                                           const Pose& stood) {
  std::vector<RecoveryPlace> places;
  const auto found = recovery_place(rules, station, stopped_on, stood, [&](const RecoveryPlace& place) {
    places.push_back(place);
    return false;
  });
  EXPECT_FALSE(found);
  return places;
}

std::vector<std::uint32_t> stations_of(const std::vector<RecoveryPlace>& places) {
  std::vector<std::uint32_t> stations;
  for (const RecoveryPlace& place : places) stations.push_back(place.station.value);
  return stations;
}

TEST(Recovery, AnAgvThatStoodComesBackToItsStationWithItsHeading) {
  const auto map = test::row_map(4);
  const Pose stood{map->station(StationId{1U}).position_m, Vec2::UnitY()};
  const auto places = recovery_places({*map, ""}, StationId{1U}, nullptr, stood);
  EXPECT_EQ(stations_of(places), (std::vector<std::uint32_t>{1, 0, 2, 3})) << "by length, then by number";
  EXPECT_EQ(places[0].pose.heading, Vec2::UnitY());
  EXPECT_EQ(places[1].pose.heading, Vec2(-1.0, 0.0)) << "as it would arrive from station 1";
  EXPECT_EQ(places[3].pose.heading, Vec2::UnitX());
  EXPECT_EQ(places[3].pose.position_m, map->station(StationId{3U}).position_m);
}

TEST(Recovery, NoPlaceIsLookedAtBeyondTheFirstThatSuits) {
  const auto map = test::row_map(40);
  std::size_t looked_at = 0;
  const auto found = recovery_place({*map, ""}, StationId{1U}, nullptr, {}, [&](const RecoveryPlace& place) {
    ++looked_at;
    return place.station == StationId{2U};
  });
  ASSERT_TRUE(found);
  EXPECT_EQ(found->station, StationId{2U});
  EXPECT_EQ(looked_at, 3U) << "stations 1, 0 and 2";
}

TEST(Recovery, AnAgvThatStoppedOnALaneIsExpectedAtItsEnd) {
  const auto map = test::row_map(4);
  const Lane* lane = map->lane(SegmentId{1U}, StationId{1U});
  ASSERT_NE(lane, nullptr);
  const auto places = recovery_places({*map, ""}, StationId{1U}, lane, {Vec2(5.0, 0.0), Vec2::UnitY()});
  EXPECT_EQ(stations_of(places), (std::vector<std::uint32_t>{2, 1, 3, 0}));
  EXPECT_EQ(places[0].pose.position_m, map->station(StationId{2U}).position_m);
  EXPECT_EQ(places[0].pose.heading, Vec2::UnitX()) << "the heading at the end of the lane";
}

TEST(Recovery, AnAgvIsSetDownAsTheStationDemandsAndNeverWhereItCouldNotDriveOff) {
  Layout layout = test::row_map(5)->layout();
  layout.stations[2].heading = Vec2::UnitY();
  layout.stations[4].turning = false;  // whoever comes to the last station could not turn back
  layout.segments[0].permissions = {{"", LoadState::Empty}};
  const LogicalMap map(layout);
  const Pose stood{map.station(StationId{1U}).position_m, Vec2::UnitX()};
  const auto empty = recovery_places({map, "", false}, StationId{1U}, nullptr, stood);
  EXPECT_EQ(stations_of(empty), (std::vector<std::uint32_t>{1, 0, 2, 3}));
  EXPECT_EQ(empty[2].pose.heading, Vec2::UnitY());
  const auto loaded = recovery_places({map, "", true}, StationId{1U}, nullptr, stood);
  EXPECT_EQ(stations_of(loaded), (std::vector<std::uint32_t>{1, 2, 3})) << "a load may not leave station 0";
}

}  // namespace
}  // namespace fleetproof::operator_actions_test
