#include "core/engine/briefings.hpp"

#include <gtest/gtest.h>

#include "tests/support/worlds.hpp"

namespace fleetproof::briefings_test {
namespace {

FleetSoftware software(const char* config = "") { return FleetSoftware(test::handler_agent(), config); }

TEST(Briefings, HoldMapFleetAndScript) {
  Scenario scenario = test::row_scenario(3, {2, 0});
  scenario.law.safety_distance_m = 0.2;
  scenario.agvs[1].script = {{seconds(1.5), ScriptedCall::Action::Pick, SegmentId{1U}}};
  const ToldPlant plant(scenario);
  const Briefings briefings(scenario, software("config"), plant);
  const fp_briefing& first = briefings.of(AgvId{0U});
  EXPECT_EQ(first.self, 0U);
  EXPECT_EQ(first.start_station, 2U);
  EXPECT_EQ(first.fleet_count, 2U);
  EXPECT_EQ(first.script_count, 0U);
  EXPECT_EQ(first.safety_distance_m, 0.2);
  EXPECT_STREQ(first.config, "config");
  EXPECT_EQ(first.fleet[1].length_m, scenario.vehicle_types[0].footprint.length_m);
  EXPECT_EQ(first.boot, 0U);
  EXPECT_EQ(first.start_segment, FP_NONE);
  EXPECT_EQ(first.next_segment, FP_NONE);
  ASSERT_EQ(first.map->station_count, 3U);
  EXPECT_STREQ(first.map->stations[1].name, "s1");
  EXPECT_EQ(first.map->stations[1].x_m, 4.0);
  ASSERT_EQ(first.map->lane_count, 4U) << "two segments, both ways";
  EXPECT_EQ(first.map->lanes[0].length_m, 4.0);
  const fp_briefing& second = briefings.of(AgvId{1U});
  EXPECT_EQ(second.self, 1U);
  ASSERT_EQ(second.script_count, 1U);
  EXPECT_EQ(second.script[0].at_ns, 1'500'000'000);
  EXPECT_EQ(second.script[0].segment, 1U);
}

TEST(Briefings, TheAgentsShareTheirFactsUnlessTheyMustNot) {
  Scenario scenario = test::row_scenario(3, {2, 0});
  scenario.law.safety_distance_m = 0.2;
  const ToldPlant plant(scenario);
  const Briefings shared(scenario, software(), plant), apart(scenario, software(), plant, false);
  const fp_facts& facts = *shared.of(AgvId{0U}).facts;
  EXPECT_EQ(shared.of(AgvId{1U}).facts, &facts);
  EXPECT_NE(apart.of(AgvId{1U}).facts, apart.of(AgvId{0U}).facts);
  EXPECT_EQ(facts.map, shared.of(AgvId{0U}).map);
  EXPECT_EQ(facts.fleet, shared.of(AgvId{0U}).fleet);
  EXPECT_EQ(facts.fleet_count, 2U);
  EXPECT_EQ(facts.safety_distance_m, 0.2);
}

TEST(Briefings, TellLimitsAndBlocksOfTheLanes) {
  Layout layout = test::row_scenario(3, {0}).map->layout();
  layout.blocks = {{"dock", BlockKind::OneVehicle}, {"aisle", BlockKind::SameDirection}};
  layout.segments[1].speed_limit_mps = 0.5;
  layout.segments[1].back_speed_limit_mps = 0.25;
  layout.segments[1].width_m = 1.8;
  layout.segments[1].blocks = {0, 1};
  Scenario scenario = test::row_scenario(3, {0});
  scenario.map = std::make_shared<const LogicalMap>(layout);
  const ToldPlant plant(scenario);
  const Briefings briefings(scenario, software(), plant);
  const fp_map& map = *briefings.of(AgvId{0U}).map;
  ASSERT_EQ(map.block_count, 2U);
  EXPECT_STREQ(map.blocks[0].name, "dock");
  EXPECT_EQ(map.blocks[1].kind, static_cast<std::uint32_t>(FP_SAME_DIRECTION));
  const fp_lane &free = map.lanes[0], &there = map.lanes[2], &back = map.lanes[3];
  EXPECT_EQ(free.speed_limit_mps, 0.0);
  EXPECT_EQ(free.block_count, 0U);
  EXPECT_EQ(there.speed_limit_mps, 0.5);
  EXPECT_EQ(back.speed_limit_mps, 0.25);
  EXPECT_EQ(back.width_m, 1.8);
  ASSERT_EQ(there.block_count, 2U);
  EXPECT_EQ(there.blocks[1], 1U);
}

TEST(Briefings, AfterARestartTellWhereTheAgvIs) {
  const Scenario scenario = test::row_scenario(3, {0, 2});
  const ToldPlant plant(scenario);
  Briefings briefings(scenario, software(), plant);
  const Lane *lane = scenario.map->lane(SegmentId{0U}, StationId{0U}),
             *next = scenario.map->lane(SegmentId{1U}, StationId{1U});
  briefings.renew(AgvId{0U}, 3, StationId{0U}, lane, next);
  EXPECT_EQ(briefings.of(AgvId{0U}).boot, 3U);
  EXPECT_EQ(briefings.of(AgvId{0U}).start_segment, 0U);
  EXPECT_EQ(briefings.of(AgvId{0U}).next_segment, 1U);
  EXPECT_EQ(briefings.of(AgvId{1U}).boot, 0U) << "the other one has not restarted";
  briefings.renew(AgvId{0U}, 4, StationId{1U}, nullptr, nullptr);
  EXPECT_EQ(briefings.of(AgvId{0U}).start_station, 1U);
  EXPECT_EQ(briefings.of(AgvId{0U}).start_segment, FP_NONE);
  EXPECT_EQ(briefings.of(AgvId{0U}).next_segment, FP_NONE);
}

TEST(Briefings, NameParticipantsTypesAndSegments) {
  Scenario scenario = test::row_scenario(3, {0, 2});
  scenario.vehicle_types[0].name = "tug";
  scenario.computers = {{.name = "broker"}, {.name = "master", .at_m = Vec2(3.0, 4.0)}};
  const fp_agent_type& type = test::handler_agent();
  const ToldPlant plant(scenario);
  const Briefings briefings(scenario, {{&type, "vehicle"}, {{&type, "first"}, {&type, "second"}}}, plant);
  const fp_briefing& agv = briefings.of(AgvId{1U});
  EXPECT_EQ(agv.role, static_cast<std::uint32_t>(FP_AGV));
  EXPECT_STREQ(agv.config, "vehicle");
  EXPECT_STREQ(agv.agv_names[1], "agv-2");
  ASSERT_EQ(agv.vehicle_type_count, 1U);
  EXPECT_STREQ(agv.vehicle_type_names[0], "tug");
  EXPECT_STREQ(agv.segment_names[1], "e1");
  ASSERT_EQ(agv.computer_count, 2U);
  EXPECT_STREQ(agv.computers[0].name, "broker");
  EXPECT_EQ(agv.computers[0].has_antenna, 0U);
  EXPECT_EQ(agv.computers[1].has_antenna, 1U);
  EXPECT_EQ(agv.computers[1].y_m, 4.0);
  const fp_briefing& master = briefings.of(EntityId{3U});
  EXPECT_EQ(master.self, 3U);
  EXPECT_EQ(master.fleet_count, 2U);
  EXPECT_EQ(master.role, static_cast<std::uint32_t>(FP_COMPUTER));
  EXPECT_EQ(master.start_station, FP_NONE);
  EXPECT_STREQ(master.config, "second");
}

}  // namespace
}  // namespace fleetproof::briefings_test
