// Planted bad scenarios: each must be refused for the reason that was planted.
#include "generators/scenario_file/validator.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <set>

#include "generators/map/layout_check.hpp"
#include "generators/worlds/world_maker.hpp"

namespace fleetproof::validator_test {
namespace {

Scenario sound() {
  RejectionCounts counts;
  return generate_world(WorldSpec{}, 11, counts);
}

Layout with_layout(const Scenario& s, const std::function<void(Layout&)>& change) {
  Layout layout = s.map->layout();
  change(layout);
  return layout;
}

// All lanes lead to the station, none away: one of many, so that the core stays above 90 %. Only for spurs.
Layout with_trap(const Scenario& s, StationId station) {
  return with_layout(s, [&](Layout& l) {
    for (auto& segment : l.segments) {
      if (segment.from == station) std::swap(segment.from, segment.to);
      if (segment.to == station) segment.bidirectional = false;
    }
  });
}

struct Plant {
  const char* name;
  ProblemKind kind;
  const char* pointer;
  std::function<void(Scenario&)> change;

  friend void PrintTo(const Plant& plant, std::ostream* out) { *out << plant.name; }
};

const double kNan = std::numeric_limits<double>::quiet_NaN();

const Plant kPlants[] = {
    {"too_many_agvs", ProblemKind::NumberOutOfRange, "/agvs",
     [](Scenario& s) {
       while (s.agvs.size() < 65537) {
         s.agvs.push_back(s.agvs.front());
         s.agvs.back().name = "more " + std::to_string(s.agvs.size());
       }
     }},
    {"loss", ProblemKind::NumberOutOfRange, "/radio/loss", [](Scenario& s) { s.radio.loss = 1.01; }},
    {"mean_outage", ProblemKind::NumberOutOfRange, "/radio/mean_outage_s",
     [](Scenario& s) { s.radio.outages.mean_outage_s = -1.0; }},
    {"mean_outage_nan", ProblemKind::NumberOutOfRange, "/radio/mean_outage_s",
     [](Scenario& s) { s.radio.outages.mean_outage_s = kNan; }},
    {"delay_median", ProblemKind::NumberOutOfRange, "/radio/delay_median_share",
     [](Scenario& s) { s.radio.delay_tail.median_share = 0.1; }},
    {"delay_cap", ProblemKind::NumberOutOfRange, "/radio/delay_cap_share",
     [](Scenario& s) { s.radio.delay_tail.cap_share = 0.1; }},
    {"asymmetric_places", ProblemKind::NumberOutOfRange, "/radio/asymmetry",
     [](Scenario& s) {
       s.radio.outages = {.mean_outage_s = 1.0, .scope = OutageSetup::Scope::Place};
       s.radio.asymmetry = 0.1;
     }},
    {"border", ProblemKind::NumberOutOfRange, "/radio/roaming_border_m",
     [](Scenario& s) { s.radio.places.roaming_border_m = 14.1; }},
    {"roaming", ProblemKind::NumberOutOfRange, "/radio/roaming_max_s",
     [](Scenario& s) { s.radio.places.roaming_max_s = 1.0; }},
    {"slot", ProblemKind::NumberOutOfRange, "/radio/air_time_s",
     [](Scenario& s) {
       s.radio.contention.interference = true;
       s.radio.air_time_s = 0.0;
     }},
    {"long_slot", ProblemKind::NumberOutOfRange, "/radio/air_time_per_byte_s",
     [](Scenario& s) {
       s.radio.contention.interference = true;
       s.radio.air_time_per_byte_s = 0.001;
     }},
    {"air_time_per_byte", ProblemKind::NumberOutOfRange, "/radio/air_time_per_byte_s",
     [](Scenario& s) { s.radio.air_time_per_byte_s = -1e-9; }},
    {"source_off", ProblemKind::NumberOutOfRange, "/radio/sources/1/mean_off_s",
     [](Scenario& s) {
       s.radio.sources = {{}, {.mean_off_s = -0.1}};
     }},
    {"source_on", ProblemKind::NumberOutOfRange, "/radio/sources/0/mean_on_s",
     [](Scenario& s) { s.radio.sources = {{.mean_on_s = 0.0}}; }},
    {"source_range", ProblemKind::NumberOutOfRange, "/radio/sources/0/range_m",
     [](Scenario& s) { s.radio.sources = {{.range_m = 0.0}}; }},
    {"source_place", ProblemKind::NumberOutOfRange, "/radio/sources/0/x_m",
     [](Scenario& s) { s.radio.sources = {{.x_m = kNan}}; }},
    {"recorded_to_itself", ProblemKind::NumberOutOfRange, "/radio/trace/0",
     [](Scenario& s) {
       s.radio.trace = std::make_shared<const RadioTrace>(RadioTrace{{AgvId{1U}, AgvId{1U}, Duration{0}, Duration{1}}});
     }},
    {"loss_nan", ProblemKind::NumberOutOfRange, "/radio/loss", [](Scenario& s) { s.radio.loss = kNan; }},
    {"delay", ProblemKind::NumberOutOfRange, "/radio/delay_s", [](Scenario& s) { s.radio.delay_s = -1; }},
    {"range", ProblemKind::NumberOutOfRange, "/radio/range_m", [](Scenario& s) { s.radio.range_m = 0; }},
    {"air_time", ProblemKind::NumberOutOfRange, "/radio/air_time_s", [](Scenario& s) { s.radio.air_time_s = -1; }},
    {"call_cost", ProblemKind::NumberOutOfRange, "/agent_clock/call_cost_s",
     [](Scenario& s) { s.agent_clock.call_cost_s = -1; }},
    {"safety", ProblemKind::NumberOutOfRange, "/law/safety_distance_m",
     [](Scenario& s) { s.law.safety_distance_m = -0.1; }},
    {"snapshot", ProblemKind::NumberOutOfRange, "/law/snapshot_s", [](Scenario& s) { s.law.snapshot_s = 0; }},
    {"horizon", ProblemKind::NumberOutOfRange, "/horizon_ns", [](Scenario& s) { s.horizon = Duration::zero(); }},
    {"stuck", ProblemKind::NumberOutOfRange, "/stuck_after_ns", [](Scenario& s) { s.stuck_after = Duration{-1}; }},
    {"no_agv", ProblemKind::EmptyFleet, "/agvs", [](Scenario& s) { s.agvs.clear(); }},
    {"same_name", ProblemKind::BadName, "/agvs/1/name", [](Scenario& s) { s.agvs[1].name = s.agvs[0].name; }},
    {"no_name", ProblemKind::BadName, "/agvs/0/name", [](Scenario& s) { s.agvs[0].name = ""; }},
    {"latin1_name", ProblemKind::BadName, "/agvs/0/name", [](Scenario& s) { s.agvs[0].name = "caf\xe9"; }},
    {"type", ProblemKind::UnknownReference, "/agvs/0/type", [](Scenario& s) { s.agvs[0].type = 1; }},
    {"exempt_pair", ProblemKind::UnknownReference, "/law/exempt_pairs/1",
     [](Scenario& s) {
       s.law.exempt_pairs = {{"obstacle", s.vehicle_types[0].name}, {s.vehicle_types[0].name, "nobody"}};
     }},
    {"no_type", ProblemKind::UnknownReference, "/vehicle_types", [](Scenario& s) { s.vehicle_types.clear(); }},
    {"start", ProblemKind::UnknownReference, "/agvs/2/start", [](Scenario& s) { s.agvs[2].start = StationId{9999U}; }},
    {"heading", ProblemKind::NumberOutOfRange, "/agvs/0/heading",
     [](Scenario& s) {
       s.agvs[0].heading = {2, 0};
     }},
    {"battery", ProblemKind::NumberOutOfRange, "/agvs/0/battery", [](Scenario& s) { s.agvs[0].battery = 1.5; }},
    {"length", ProblemKind::NumberOutOfRange, "/vehicle_types/0/length_m",
     [](Scenario& s) { s.vehicle_types[0].footprint.length_m = 0; }},
    {"speed", ProblemKind::NumberOutOfRange, "/vehicle_types/0/drive/speed_mps",
     [](Scenario& s) { s.vehicle_types[0].drive.speed_mps = kNan; }},
    {"turn", ProblemKind::NumberOutOfRange, "/vehicle_types/0/turn/acceleration_radps2",
     [](Scenario& s) { s.vehicle_types[0].turn.acceleration_radps2 = 0; }},
    {"pick", ProblemKind::NumberOutOfRange, "/vehicle_types/0/pick_s",
     [](Scenario& s) { s.vehicle_types[0].pick_s = -5; }},
    {"to", ProblemKind::UnknownReference, "/agvs/0/transports/0/to",
     [](Scenario& s) { s.agvs[0].transports[0].to = StationId{}; }},
    {"to_itself", ProblemKind::UnknownReference, "/agvs/0/transports/0/to",
     [](Scenario& s) { s.agvs[0].transports[0].to = s.agvs[0].transports[0].from; }},
    {"release", ProblemKind::NumberOutOfRange, "/agvs/0/transports/0/release_ns",
     [](Scenario& s) { s.agvs[0].transports[0].release = Duration{-1}; }},
    {"script", ProblemKind::UnknownReference, "/agvs/0/script/0/segment",
     [](Scenario& s) {
       s.agvs[0].script = {{Duration{}, ScriptedCall::Action::Move, SegmentId{1'000'000U}}};
     }},
    {"script_move", ProblemKind::UnknownReference, "/agvs/0/script/0/action",
     [](Scenario& s) {
       s.agvs[0].script = {{Duration{}, ScriptedCall::Action::Move, SegmentId{}}};
     }},
    {"script_backward", ProblemKind::UnknownReference, "/agvs/0/script/0/backward",
     [](Scenario& s) {
       s.agvs[0].script = {{Duration{}, ScriptedCall::Action::Drop, SegmentId{}, true}};
     }},
    {"script_order", ProblemKind::NumberOutOfRange, "/agvs/0/script/1/at_ns",
     [](Scenario& s) {
       s.agvs[0].script = {{Duration{5}, ScriptedCall::Action::Move, SegmentId{0U}},
                           {Duration{4}, ScriptedCall::Action::Move, SegmentId{0U}}};
     }},
    {"obstacle", ProblemKind::NumberOutOfRange, "/obstacles/0/width_m",
     [](Scenario& s) {
       s.obstacles = {{"rack", {1.0, -1.0}, {}}};
     }},
    {"starts", ProblemKind::StartsTooClose, "/agvs/1/start", [](Scenario& s) { s.agvs[1].start = s.agvs[0].start; }},
    {"on_obstacle", ProblemKind::StartNearObstacle, "/agvs/3/start",
     [](Scenario& s) {
       s.obstacles = {{"rack",
                       {1.0, 1.0},
                       {s.map->station(s.agvs[3].start).position_m + 1.35 * s.agvs[3].heading, Vec2::UnitX()}}};
     }},
    {"width", ProblemKind::NumberOutOfRange, "/vehicle_types/0/width_m",
     [](Scenario& s) { s.vehicle_types[0].footprint.width_m = 101; }},
    {"acceleration", ProblemKind::NumberOutOfRange, "/vehicle_types/0/drive/acceleration_mps2",
     [](Scenario& s) { s.vehicle_types[0].drive.acceleration_mps2 = 0; }},
    {"deceleration", ProblemKind::NumberOutOfRange, "/vehicle_types/0/drive/deceleration_mps2",
     [](Scenario& s) { s.vehicle_types[0].drive.deceleration_mps2 = 2e6; }},
    {"turn_speed", ProblemKind::NumberOutOfRange, "/vehicle_types/0/turn/speed_radps",
     [](Scenario& s) { s.vehicle_types[0].turn.speed_radps = -1; }},
    {"turn_deceleration", ProblemKind::NumberOutOfRange, "/vehicle_types/0/turn/deceleration_radps2",
     [](Scenario& s) { s.vehicle_types[0].turn.deceleration_radps2 = kNan; }},
    {"battery_per_m", ProblemKind::NumberOutOfRange, "/vehicle_types/0/battery_per_m",
     [](Scenario& s) { s.vehicle_types[0].battery_per_m = -0.1; }},
    {"charge", ProblemKind::NumberOutOfRange, "/vehicle_types/0/charge_per_s",
     [](Scenario& s) { s.vehicle_types[0].charge_per_s = 1.1; }},
    {"drop", ProblemKind::NumberOutOfRange, "/vehicle_types/0/drop_s",
     [](Scenario& s) { s.vehicle_types[0].drop_s = 2e9; }},
    {"release_late", ProblemKind::NumberOutOfRange, "/agvs/0/transports/0/release_ns",
     [](Scenario& s) { s.agvs[0].transports[0].release = std::chrono::seconds(1'000'000'001); }},
    {"obstacle_length", ProblemKind::NumberOutOfRange, "/obstacles/0/length_m",
     [](Scenario& s) {
       s.obstacles = {{"rack", {0.0, 1.0}, {}}};
     }},
    {"obstacle_heading", ProblemKind::NumberOutOfRange, "/obstacles/0/heading",
     [](Scenario& s) {
       s.obstacles = {{"rack", {1.0, 1.0}, {{90.0, 90.0}, {0.5, 0.5}}}};
     }},
    {"obstacle_position", ProblemKind::NumberOutOfRange, "/obstacles/0/position_m",
     [](Scenario& s) {
       s.obstacles = {{"rack", {1.0, 1.0}, {{kNan, 90.0}, Vec2::UnitX()}}};
     }},
    {"scenario_name", ProblemKind::BadName, "/name", [](Scenario& s) { s.name = "line\nbreak"; }},
    {"type_name", ProblemKind::BadName, "/vehicle_types/0/name", [](Scenario& s) { s.vehicle_types[0].name = ""; }},
    {"same_type_name", ProblemKind::BadName, "/vehicle_types/1/name",
     [](Scenario& s) { s.vehicle_types.push_back(s.vehicle_types[0]); }},
    {"obstacle_name", ProblemKind::BadName, "/obstacles/0/name",
     [](Scenario& s) {
       s.obstacles = {{"", {1.0, 1.0}, {{90.0, 90.0}, Vec2::UnitX()}}};
     }},
    {"long_name", ProblemKind::BadName, "/agvs/0/name", [](Scenario& s) { s.agvs[0].name = std::string(201, 'a'); }},
    {"from", ProblemKind::UnknownReference, "/agvs/0/transports/0/from",
     [](Scenario& s) { s.agvs[0].transports[0].from = StationId{}; }},
    {"start_without_lane", ProblemKind::StartWithoutLane, "/agvs/0/start",
     [](Scenario& s) {
       s.agvs.resize(1);
       s.map = std::make_shared<const LogicalMap>(with_trap(s, s.agvs[0].start));
     }},
    {"unreachable", ProblemKind::Unreachable, "/agvs/0/transports/0/from",
     [](Scenario& s) {
       const StationId lost = s.agvs[0].transports[0].to;
       s.agvs.resize(1);
       s.agvs[0].transports.resize(1);
       if (s.agvs[0].start == lost) s.agvs[0].start = s.agvs[0].transports[0].from;
       s.map = std::make_shared<const LogicalMap>(with_trap(s, lost));
     }},
    {"delivery_of_nobody", ProblemKind::UnknownReference, "/fates/0/receiver",
     [](Scenario& s) {
       s.deliveries = {{AgvId{0U}, AgvId{99U}, {}, 0, true, {}}};
     }},
    {"delivery_of_itself", ProblemKind::UnknownReference, "/fates/0/receiver",
     [](Scenario& s) {
       s.deliveries = {{AgvId{1U}, AgvId{1U}, {}, 0, true, {}}};
     }},
    {"two_deliveries", ProblemKind::UnknownReference, "/fates/1",
     [](Scenario& s) {
       s.deliveries = {{AgvId{0U}, AgvId{1U}, {}, 0, true, {}}, {AgvId{0U}, AgvId{1U}, {}, 0, false, {}}};
     }},
    {"late_delivery", ProblemKind::NumberOutOfRange, "/fates/0/delay_ns",
     [](Scenario& s) {
       s.deliveries = {{AgvId{0U}, AgvId{1U}, {}, 0, false, std::chrono::hours(2)}};
     }},
    {"computer_without_name", ProblemKind::BadName, "/computers/0/name",
     [](Scenario& s) { s.computers = {{.name = ""}}; }},
    {"two_computers_of_one_name", ProblemKind::BadName, "/computers/1/name",
     [](Scenario& s) {
       s.computers = {{.name = "server"}, {.name = "server"}};
     }},
    {"computer_called_as_an_agv", ProblemKind::BadName, "/computers/0/name",
     [](Scenario& s) { s.computers = {{.name = s.agvs[1].name}}; }},
    {"antenna_far_out", ProblemKind::NumberOutOfRange, "/computers/0/at_m",
     [](Scenario& s) { s.computers = {{.name = "server", .at_m = Vec2(0.0, 1e6)}}; }},
    {"wire_delay", ProblemKind::NumberOutOfRange, "/wire/takes_s", [](Scenario& s) { s.wire.takes_s = -1.0; }},
    {"too_many_computers", ProblemKind::NumberOutOfRange, "/computers",
     [](Scenario& s) {
       for (int i = 0; i < 257; ++i) s.computers.push_back({.name = "c" + std::to_string(i)});
     }},
    {"breakdown_of_a_computer", ProblemKind::UnknownReference, "/faults/0/kind",
     [](Scenario& s) {
       s.computers = {{.name = "server"}};
       s.faults = {{.kind = Fault::Kind::Breakdown, .agv = s.first_computer(), .transport = {}}};
     }},
    {"fault_at_a_pick_of_a_computer", ProblemKind::UnknownReference, "/faults/0/transport",
     [](Scenario& s) {
       s.computers = {{.name = "server"}};
       s.faults = {{.kind = Fault::Kind::Freeze, .agv = s.first_computer(), .transport = 0U}};
     }},
    {"fault_of_nobody", ProblemKind::UnknownReference, "/faults/0/agv",
     [](Scenario& s) {
       s.computers = {{.name = "server"}};
       s.faults = {{.kind = Fault::Kind::Freeze, .agv = s.first_obstacle(), .transport = {}}};
     }},
    {"fault_of_nothing", ProblemKind::UnknownReference, "/faults/0/agv",
     [](Scenario& s) {
       s.faults = {{.kind = Fault::Kind::LoadDrop, .agv = {}, .transport = {}}};
     }},
    {"fault_of_an_unknown_open_transport", ProblemKind::UnknownReference, "/faults/0/transport",
     [](Scenario& s) {
       s.open_orders = {s.agvs[0].transports[0]};
       s.faults = {{.kind = Fault::Kind::LoadDrop, .agv = {}, .transport = 1U}};
     }},
    {"open_transport_to_itself", ProblemKind::UnknownReference, "/transports/0/to",
     [](Scenario& s) {
       s.open_orders = {s.agvs[0].transports[0]};
       s.open_orders[0].to = s.open_orders[0].from;
     }},
    {"open_transport_to_nowhere", ProblemKind::UnknownReference, "/transports/0/to",
     [](Scenario& s) {
       s.open_orders = {s.agvs[0].transports[0]};
       s.open_orders[0].to = StationId{};
     }},
    {"withdrawn_before_its_release", ProblemKind::NumberOutOfRange, "/agvs/0/transports/0/withdrawn_ns",
     [](Scenario& s) {
       s.agvs[0].transports[0].release = Duration{2};
       s.agvs[0].transports[0].withdrawn = Duration{1};
     }},
    {"withdrawn_late", ProblemKind::NumberOutOfRange, "/transports/0/withdrawn_ns",
     [](Scenario& s) {
       s.open_orders = {s.agvs[0].transports[0]};
       s.open_orders[0].withdrawn = std::chrono::seconds(1'000'000'001);
     }},
    {"delivery_by_wire", ProblemKind::UnknownReference, "/fates/0",
     [](Scenario& s) {
       s.computers = {{.name = "broker"}, {.name = "master"}};
       s.deliveries = {{.sender = s.first_computer(), .receiver = EntityId{s.agvs.size() + 1}}};
     }},
    {"computers_with_one_number", ProblemKind::NumberOutOfRange, "/computers/1/draws_as",
     [](Scenario& s) {
       s.computers = {{.name = "broker"}, {.name = "master", .draws_as = 0}};
     }},
    {"agv_with_the_number_of_a_computer", ProblemKind::NumberOutOfRange, "/agvs/0/draws_as",
     [](Scenario& s) {
       s.computers = {{.name = "server"}};
       s.agvs[0].draws_as = 65535;
     }},
    {"weak_core", ProblemKind::WeakCore, "/layout",
     [](Scenario& s) {
       s.map = std::make_shared<const LogicalMap>(with_layout(s, [](Layout& l) {
         for (auto& segment : l.segments) segment.bidirectional = false;
       }));
     }},
};

class PlantedScenario : public testing::TestWithParam<Plant> {};

TEST_P(PlantedScenario, IsRefusedForWhatWasPlanted) {
  Scenario s = sound();
  ASSERT_TRUE(problems_of(s).empty());
  GetParam().change(s);
  const auto problems = problems_of(s);
  ASSERT_FALSE(problems.empty());
  EXPECT_EQ(problems[0].kind, GetParam().kind) << problems[0].sentence;
  EXPECT_EQ(problems[0].pointer, GetParam().pointer);
  EXPECT_FALSE(problems[0].sentence.empty());
  // The first five kinds make a scenario unusable.
  EXPECT_EQ(unusable_problems(s).empty(), GetParam().kind > ProblemKind::EmptyFleet);
}

INSTANTIATE_TEST_SUITE_P(All, PlantedScenario, testing::ValuesIn(kPlants),
                         [](const auto& test) { return test.param.name; });

TEST(Validator, AStationWithoutWayBackIsFoundAsUnreachable) {
  Scenario s = sound();
  StationId lost{};
  // One of many stations becomes a trap: the core stays above 90 %.
  s.map = std::make_shared<const LogicalMap>(with_layout(s, [&](Layout& l) {
    for (std::size_t i = 0; i < l.stations.size(); ++i) {
      if (l.stations[i].name == "dock1") lost = StationId{i};
    }
    for (auto& segment : l.segments) {
      if (segment.to == lost) segment.bidirectional = false;
    }
  }));
  auto& order = s.agvs[0].transports[0];
  if (order.from == lost) std::swap(order.from, order.to);
  order.to = lost;
  s.agvs.resize(1);
  s.agvs[0].transports.resize(1);
  const auto problems = problems_of(s);
  ASSERT_FALSE(problems.empty());
  EXPECT_EQ(problems.back().kind, ProblemKind::Unreachable);
}

TEST(Validator, StartsAtExactlyTheSafetyDistanceAreAllowed) {
  Scenario s = sound();
  s.agvs.resize(2);
  for (auto& agv : s.agvs) agv.transports.clear();
  Layout layout;
  layout.stations = {{"a", {0, 0}, Purpose::Parking}, {"b", {0, 1.1}, Purpose::Parking}};
  layout.segments = {{"ab", StationId{0U}, StationId{1U}, true, {}}};
  s.agvs[0].start = StationId{0U};
  s.agvs[1].start = StationId{1U};
  s.agvs[0].heading = s.agvs[1].heading = Vec2::UnitX();
  s.map = std::make_shared<const LogicalMap>(layout);
  EXPECT_TRUE(problems_of(s).empty());
  layout.stations[1].position_m.y() = 1.0999;
  s.map = std::make_shared<const LogicalMap>(layout);
  EXPECT_EQ(problems_of(s).size(), 1U);
}

TEST(LayoutCheck, FindsWhatCannotBeDriven) {
  const auto kind_after = [](const std::function<void(Layout&)>& change) {
    const auto problems = problems_of(with_layout(sound(), change));
    return problems.empty() ? std::string("sound") : std::string(name_of(problems[0].kind)) + problems[0].pointer;
  };
  EXPECT_EQ(kind_after([](Layout&) {}), "sound");
  EXPECT_EQ(kind_after([](Layout& l) { l.stations.clear(); }), "bad-geometry/stations");
  EXPECT_EQ(kind_after([](Layout& l) { l.stations[3].name = l.stations[2].name; }), "bad-name/stations/3/name");
  EXPECT_EQ(kind_after([](Layout& l) { l.stations[3].position_m.x() = kNan; }),
            "number-out-of-range/stations/3/position_m");
  EXPECT_EQ(kind_after([](Layout& l) { l.segments[0].to = l.segments[0].from; }), "bad-geometry/segments/0");
  EXPECT_EQ(kind_after([](Layout& l) { l.segments[0].to = StationId{}; }), "unknown-reference/segments/0/to");
  EXPECT_EQ(kind_after([](Layout& l) {
              l.segments[0].control_points_m = {{0, 0}};
            }),
            "bad-geometry/segments/0/control_points_m");
  EXPECT_EQ(kind_after([](Layout& l) {
              l.segments[0].control_points_m = {{kNan, 0}, {1, 1}};
            }),
            "number-out-of-range/segments/0/control_points_m");
  EXPECT_EQ(kind_after([](Layout& l) { std::swap(l.floor_low_m, l.floor_high_m); }),
            "number-out-of-range/floor_high_m");
  EXPECT_EQ(kind_after([](Layout& l) {  // the tangents cross: a cusp half-way
              const Vec2 a = l.stations[l.segments[0].from.index()].position_m,
                         b = l.stations[l.segments[0].to.index()].position_m;
              l.segments[0].control_points_m = {b + left_of(b - a), a + left_of(b - a)};
            }),
            "bad-geometry/segments/0");
  EXPECT_EQ(kind_after([](Layout& l) {  // two pieces that meet at a right angle
              const Vec2 a = l.stations[l.segments[0].from.index()].position_m;
              l.segments[0].control_points_m = {a + Vec2(1, 0), a + Vec2(2, 0), a + Vec2(3, 0), a + Vec2(3, 1),
                                                a + Vec2(3, 2)};
            }),
            "bad-geometry/segments/0");
}

// The list is complete as far as kinds go: of those that a layout in use cannot have (BadGeometry), LayoutCheck has its
// own.
TEST(PlantedScenarios, CoverEveryKindOfProblem) {
  std::set<ProblemKind> planted{ProblemKind::BadGeometry};
  for (const auto& plant : kPlants) planted.insert(plant.kind);
  EXPECT_EQ(planted.size(), kProblemKinds);
}

}  // namespace
}  // namespace fleetproof::validator_test
