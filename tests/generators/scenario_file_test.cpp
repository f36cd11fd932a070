#include "generators/scenario_file/scenario_file.hpp"
#include "generators/scenario_file/scenario_text.hpp"

#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "core/scenario/canonical_bytes.hpp"
#include "core/scenario/radio_fields.hpp"
#include "generators/families/layout_family.hpp"
#include "generators/scenario_file/validator.hpp"
#include "generators/worlds/world_maker.hpp"
#include "independent_check.hpp"

namespace fleetproof::scenario_file_test {
namespace {

const std::string kFigure4 = independent::source_file("tests/scenarios/figure4.json");
const std::string kParked = independent::source_file("tests/scenarios/parked_then_leaves.json");

void add_computers_and_faults(Scenario& s) {
  s.faults = {{Fault::Kind::Breakdown, AgvId{1U}, Duration{11}, std::nullopt, Duration{12}, {}, 0.0, 0.0},
              {Fault::Kind::LoadDrop, AgvId{2U}, Duration{13}, 0U, Duration{14}, {1.1, 0.7}, -2.0, 0.4}};
  s.computers = {{.name = "broker", .clock_offset_s = 0.5, .clock_drift_ppm = -7.0},
                 {.name = "master", .at_m = Vec2(1.5, -2.0), .agent = "planner", .agent_config = "x=1", .draws_as = 4}};
  s.wire.takes_s = 0.02;
  s.faults.push_back({.kind = Fault::Kind::Restart,
                      .agv = s.first_computer(),
                      .at = Duration{15},
                      .transport = {},
                      .lasts = Duration{16}});
  s.open_orders = {s.agvs[0].transports[0], s.agvs[0].transports[0]};
  s.open_orders[1].withdrawn = s.open_orders[1].release + Duration{17};
  s.faults.push_back({.kind = Fault::Kind::LoadDrop, .agv = {}, .at = Duration{18}, .transport = 1U});
}

// Every field different from its default.
Scenario unusual() {
  RejectionCounts counts;
  Scenario s = generate_world(WorldSpec{}, 3, counts);
  s.name = "odd \"one\"";
  s.seed = 0xfedcba9876543210ULL;
  s.horizon = Duration{123'456'789'012};
  s.stuck_after = Duration{7};
  s.contact_stops = false;
  s.radio = {0.1 + 0.2, 1.0 / 3.0, RadioSetup::DelayModel::Uniform, 55.5, 12.5, 0.25, 8e-6};
  s.radio.outages = {0.75, OutageSetup::Model::HeavyTail, 1.25, OutageSetup::Scope::Direction, 0.02, 0.98};
  s.radio.delay_tail = {0.2, 0.3, 2.5, 0.0};
  s.radio.adverse.adverse_from_s = 3.5;
  s.radio.adverse.adverse_until_s = 50.25;
  s.radio.adverse.spared_kinds = {"STATE", "a \"kind\""};
  s.radio.asymmetry = 0.4;
  s.radio.duplicates = 0.05;
  s.radio.places = {30.0, true, 2.5, 0.02, 0.05, 7.0};
  s.radio.contention = {true, 15};
  s.radio.sources = {{1.5, -2.5, 3.25, 0.125, 0.5, 0.75}, {.x_m = 1e-3, .y_m = 7.0}};
  s.radio.trace = std::make_shared<const RadioTrace>(
      RadioTrace{{AgvId{0U}, AgvId{1U}, Duration{5}, Duration{17}}, {AgvId{0U}, AgvId{1U}, Duration{9}, std::nullopt}});
  s.deliveries = {{AgvId{0U}, AgvId{1U}, Duration{61'204'000'007}, 2, true, {}},
                  {AgvId{1U}, AgvId{0U}, Duration{3}, 0, false, Duration{250'000'001}, true, Duration{4}}};
  s.agvs[1].draws_as = 17;
  s.expected = {"contact, two AGVs (driving)", 0x0123456789abcdefULL};
  s.agent_clock.call_cost_s = 0.012;
  s.law = {0.3,
           0.01,
           4.5,
           12.25,
           Purposes(Purpose::Charging) | Purpose::Parking,
           1.5,
           {{"tug", "pallet-agv"}, {"obstacle", "tug"}},
           {"congestion", "progress"}};
  s.vehicle_types[0] = {"tug",
                        {2.1, 0.9, 0.3},
                        {1.5, 0.4, 0.7},
                        {0.9, 0.8, 0.6},
                        {0.3, 0.2, 0.8, 0.7},
                        0.4,
                        0.6,
                        0.05,
                        2.5,
                        1e-4,
                        1e-5,
                        2e-4,
                        7.0,
                        3.0,
                        4.0,
                        20.0,
                        6.0};
  s.vehicle_types.push_back({});
  s.agvs[1].type = 1;
  s.agvs[1].battery = 0.625;
  s.agvs[2].heading = Vec2(0.6, 0.8);
  Layout layout = s.map->layout();
  layout.segments[3].travel = Travel::Either;
  if (layout.segments[3].bidirectional) layout.segments[3].back_travel = Travel::Either;
  s.map = std::make_shared<const LogicalMap>(layout);
  s.agvs[2].script = {{Duration{5}, ScriptedCall::Action::Charge, SegmentId{3U}, true},
                      {Duration{6}, ScriptedCall::Action::Drop, SegmentId{2U}},
                      {Duration{7}, ScriptedCall::Action::Pick, SegmentId{}}};
  s.agvs[1].sensing = {0.5, -40.0, 0.01, 0.3};
  s.obstacles = {{"rack", {0.5, 3.25}, {Vec2(-30.5, 40.25), Vec2::UnitY()}, Duration{9}, Duration{10}}};
  add_computers_and_faults(s);
  s.scanner = {true, 0.1, 0.2, 3.0, 4.5};
  s.operator_help = {true, 10.0, 20.0, 0.9};
  return s;
}

void expect_same(const LawSetup& law, const LawSetup& other) {
  EXPECT_EQ(law.safety_distance_m, other.safety_distance_m);
  EXPECT_EQ(law.snapshot_s, other.snapshot_s);
  EXPECT_EQ(law.reaction_s, other.reaction_s);
  EXPECT_EQ(law.exempt_purposes, other.exempt_purposes);
  EXPECT_EQ(law.exempt_radius_m, other.exempt_radius_m);
  EXPECT_EQ(law.exempt_pairs, other.exempt_pairs);
  EXPECT_EQ(law.leave_out, other.leave_out);
  EXPECT_EQ(law.min_transports_per_agv_hour, other.min_transports_per_agv_hour);
}

TEST(ScenarioFile, OpenTransportsComeBack) {
  const Scenario s = unusual(), back = parse_scenario(to_text(s), "text");
  EXPECT_FALSE(back.faults[3].agv.valid());
  EXPECT_EQ(back.faults[3].transport, 1U);
  ASSERT_EQ(back.open_orders.size(), 2U);
  EXPECT_EQ(back.open_orders[0].withdrawn, kLongestDuration);
  EXPECT_EQ(back.open_orders[1].withdrawn, s.open_orders[1].withdrawn);
  EXPECT_EQ(back.open_orders[1].to, s.open_orders[1].to);
}

TEST(ScenarioFile, EveryFieldComesBack) {
  const Scenario s = unusual();
  const auto text = to_text(s);
  const Scenario back = parse_scenario(text, "text");
  EXPECT_EQ(to_text(back), text);
  EXPECT_EQ(back.name, s.name);
  EXPECT_EQ(back.seed, s.seed);
  EXPECT_EQ(back.horizon, s.horizon);
  EXPECT_EQ(back.stuck_after, s.stuck_after);
  EXPECT_EQ(back.contact_stops, false);
  EXPECT_EQ(back.radio.loss, s.radio.loss);
  EXPECT_EQ(back.radio.delay_s, s.radio.delay_s);
  EXPECT_EQ(back.radio.delay_model, s.radio.delay_model);
  EXPECT_EQ(back.radio.range_m, s.radio.range_m);
  EXPECT_EQ(back.radio.air_time_s, s.radio.air_time_s);
  const auto values = [](const RadioSetup& radio) {
    std::vector<double> list;
    visit_fields(radio, [&](const Field&, const auto& value) {
      if constexpr (PlainValue<std::remove_cvref_t<decltype(value)>>) list.push_back(static_cast<double>(value));
    });
    return list;
  };
  EXPECT_EQ(values(back.radio), values(s.radio));
  const RadioSetup defaults;
  for (std::size_t i = 0; i < values(defaults).size(); ++i)
    EXPECT_NE(values(s.radio)[i], values(defaults)[i]) << "field " << i << " is not tested";
  EXPECT_EQ(back.radio.sources, s.radio.sources);
  ASSERT_NE(back.radio.trace, nullptr);
  EXPECT_EQ(*back.radio.trace, *s.radio.trace);
  EXPECT_EQ(back.computers, s.computers);
  EXPECT_EQ(back.wire, s.wire);
  EXPECT_EQ(back.faults[2].agv, s.first_computer());
  EXPECT_EQ(back.agent_clock.call_cost_s, s.agent_clock.call_cost_s);
  expect_same(back.law, s.law);
  ASSERT_EQ(back.vehicle_types.size(), 2U);
  EXPECT_EQ(back.vehicle_types[0].footprint, s.vehicle_types[0].footprint);
  EXPECT_EQ(back.vehicle_types[0].drive, s.vehicle_types[0].drive);
  EXPECT_EQ(back.vehicle_types[0].turn, s.vehicle_types[0].turn);
  EXPECT_EQ(back.vehicle_types[0].reverse_speed_mps, 0.6);
  EXPECT_EQ(back.vehicle_types[0].dock_s, 7.0);
  EXPECT_EQ(back.vehicle_types[0].drop_s, 4.0);
  EXPECT_EQ(back.agvs[1].type, 1U);
  EXPECT_EQ(back.agvs[1].battery, 0.625);
  EXPECT_EQ(back.agvs[2].heading, s.agvs[2].heading);
  EXPECT_EQ(back.agvs[2].script[0].action, ScriptedCall::Action::Charge);
  EXPECT_TRUE(back.agvs[2].script[0].backward);
  EXPECT_FALSE(back.agvs[2].script[1].backward);
  EXPECT_EQ(back.agvs[2].script[1].segment, SegmentId{2U});
  EXPECT_EQ(back.agvs[0].transports[0].release, s.agvs[0].transports[0].release);
  EXPECT_EQ(back.obstacles[0].pose.position_m, s.obstacles[0].pose.position_m);
  EXPECT_EQ(back.obstacles[0].appears, Duration{9});
  EXPECT_EQ(back.obstacles[0].leaves, Duration{10});
  EXPECT_EQ(back.vehicle_types[0].loaded, s.vehicle_types[0].loaded);
  EXPECT_EQ(back.vehicle_types[0].other_spread_s, 6.0);
  EXPECT_EQ(back.agvs[1].sensing, s.agvs[1].sensing);
  EXPECT_EQ(back.deliveries, s.deliveries);
  EXPECT_EQ(back.agvs[1].draws_as, 17U);
  EXPECT_FALSE(back.agvs[0].draws_as);
  EXPECT_EQ(back.expected, s.expected);
  ASSERT_EQ(back.faults.size(), 4U);
  EXPECT_EQ(back.faults[0].kind, Fault::Kind::Breakdown);
  EXPECT_EQ(back.faults[1].transport, 0U);
  EXPECT_EQ(back.faults[1].load, s.faults[1].load);
  EXPECT_EQ(back.faults[1].left_m, 0.4);
  EXPECT_EQ(back.scanner, s.scanner);
  EXPECT_EQ(back.operator_help, s.operator_help);
}

// A call for the place where the AGV stands has no segment, in the file and in memory.
TEST(ScenarioFile, ACallWithoutASegmentComesBack) {
  const std::string text = to_text(unusual());
  EXPECT_NE(text.find(R"({"at_ns": 7, "action": "pick"})"), std::string::npos);
  EXPECT_FALSE(parse_scenario(text, "text").agvs[2].script.at(2).segment.valid());
}

TEST(ScenarioFile, GeneratedScenariosComeBackToTheByte) {
  for (const auto& family : layout_families()) {
    WorldSpec spec;
    spec.layout = std::string(family.name);
    RejectionCounts counts;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
      const auto text = to_text(generate_world(spec, seed, counts));
      EXPECT_EQ(to_text(parse_scenario(text, "text")), text);
    }
  }
}

TEST(ScenarioFile, DigestsTellScenariosApart) {
  Scenario s = unusual();
  const auto digest = scenario_digest(s);
  EXPECT_EQ(scenario_digest(parse_scenario(to_text(s), "text")), digest);
  s.radio.loss = std::nextafter(s.radio.loss, 1.0);
  EXPECT_NE(scenario_digest(s), digest);
}

TEST(ScenarioFile, Figure4IsThePaperScenario) {
  const Scenario s = read_scenario(kFigure4);
  EXPECT_EQ(s.map->station_count(), 10U);
  EXPECT_EQ(s.map->segment_count(), 12U);
  EXPECT_EQ(s.map->lanes().size(), 19U);
  EXPECT_EQ(s.horizon, std::chrono::seconds(12));
  EXPECT_EQ(s.radio.loss, 0.4);
  EXPECT_EQ(s.radio.delay_s, 2.0);
  const double lengths_m[] = {10.0, 25.0 / 6.0, 25.0 / 6.0, 1.5, 1.5};
  const int begins_s[] = {2, 4, 7, 6, 2};
  ASSERT_EQ(s.agvs.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    const auto& agv = s.agvs[i];
    EXPECT_EQ(agv.name, std::string(1, static_cast<char>('A' + i)));
    EXPECT_TRUE(agv.transports.empty());
    ASSERT_EQ(agv.script.size(), 1U);
    EXPECT_EQ(agv.script[0].action, ScriptedCall::Action::Move);
    EXPECT_EQ(agv.script[0].at, std::chrono::seconds(begins_s[i]));
    const Lane* lane = s.map->lane(agv.script[0].segment, agv.start);
    ASSERT_NE(lane, nullptr);
    EXPECT_NEAR(lane->curve.length_m(), lengths_m[i], 1e-12);
    EXPECT_EQ(lane->curve.pose_at(0.0).heading, agv.heading);
  }
  // Stations 5, 7 and 9 have no way back: a scenario for a script, not for transports.
  const auto problems = problems_of(s);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].kind, ProblemKind::WeakCore);
}

TEST(ScenarioFile, ParkedThenLeavesStartsFiveCentimetresBesideTheTrack) {
  const Scenario s = read_scenario(kParked);
  ASSERT_EQ(s.agvs.size(), 2U);
  EXPECT_EQ(s.agvs[0].name, "X");
  EXPECT_EQ(s.map->lane(s.agvs[0].script[0].segment, s.agvs[0].start)->curve.length_m(), 10.0);
  EXPECT_EQ(s.agvs[1].script[0].at, std::chrono::seconds(5));
  EXPECT_NEAR(s.map->lane(s.agvs[1].script[0].segment, s.agvs[1].start)->curve.length_m(), 25.0 / 6.0, 1e-12);
  const auto y =
      independent::corners(s.map->station(s.agvs[1].start).position_m, s.agvs[1].heading, s.vehicle_types[0].footprint);
  const auto x = independent::corners({3.0, 0.0}, s.agvs[0].heading, s.vehicle_types[0].footprint);
  EXPECT_NEAR(independent::gap_m(x, y), 0.05, 1e-12);
}

TEST(ScenarioFile, FixturesAreReadTheSameAsTheirCanonicalText) {
  for (const auto& path : {kFigure4, kParked}) {
    const auto text = to_text(read_scenario(path));
    EXPECT_EQ(to_text(parse_scenario(text, path)), text);
  }
}

}  // namespace
}  // namespace fleetproof::scenario_file_test
