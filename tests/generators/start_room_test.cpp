// An AGV may pick a load where it starts, before any AGV has moved. Its start leaves room for the body that it has
// then.
#include <gtest/gtest.h>

#include <cmath>

#include "campaign/run/agent_programs.hpp"
#include "core/engine/simulation.hpp"
#include "generators/families/layout_family.hpp"
#include "generators/map/waiting_room.hpp"
#include "generators/scenario_file/validator.hpp"
#include "generators/worlds/world_maker.hpp"
#include "independent_check.hpp"
#include "laws/laws.hpp"

namespace fleetproof::start_room_test {
namespace {

using independent::Corners;

constexpr LoadEffect kWide{.extra_length_m = 0.3, .extra_width_m = 0.2};

// The loaded body of an AGV at its start, by plain arithmetic.
Corners loaded_at_start(const Scenario& s, const AgvSetup& agv) {
  const VehicleType& type = s.vehicle_types[agv.type];
  const Footprint body{type.footprint.length_m + type.loaded.extra_length_m,
                       type.footprint.width_m + type.loaded.extra_width_m};
  return independent::corners(s.map->station(agv.start).position_m, agv.heading, body);
}

double smallest_gap_m(const Scenario& s) {
  double least_m = 1e300;
  for (std::size_t i = 0; i < s.agvs.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const Corners one = loaded_at_start(s, s.agvs[i]), other = loaded_at_start(s, s.agvs[k]);
      least_m = std::min(least_m, independent::gap_m(one, other));
    }
  }
  return least_m;
}

// Two AGVs side by side, 1.25 m from axis to axis: 0.25 m between their empty bodies, which are 1 m wide. AGV 0 starts
// at the storage station where its transport begins.
Scenario side_by_side(const LoadEffect& loaded) {
  Layout layout;
  layout.name = "side by side";
  layout.stations = {{"a", {0, 0}, Purpose::Storage},
                     {"b", {0, 1.25}, Purpose::Storage},
                     {"c", {9, 0}, Purpose::Storage},
                     {"d", {9, 1.25}, Purpose::Storage}};
  layout.segments = {{"a-c", StationId{0U}, StationId{2U}, true, {}},
                     {"c-d", StationId{2U}, StationId{3U}, true, {}},
                     {"b-d", StationId{1U}, StationId{3U}, true, {}}};
  layout.floor_low_m = {-3, -3};
  layout.floor_high_m = {12, 5};
  Scenario s;
  s.name = "side by side";
  s.map = std::make_shared<const LogicalMap>(layout);
  s.vehicle_types[0].loaded = loaded;
  s.horizon = std::chrono::seconds(60);
  s.agvs.resize(2);
  s.agvs[0].name = "picks";
  s.agvs[0].start = StationId{0U};
  s.agvs[0].transports = {{StationId{0U}, StationId{2U}, Duration{}}};
  s.agvs[1].name = "never moves";
  s.agvs[1].start = StationId{1U};
  return s;
}

Outcome outcome_of(const Scenario& s, const char* agent) {
  const AgentPrograms programs;
  std::vector<std::unique_ptr<Law>> laws;
  laws.push_back(find_law("exact")->make(s));
  return simulate(s, programs.find(agent, "test"), laws);
}

TEST(StartRoom, AnAgvThatPicksWhereItStartsGrowsIntoItsNeighbour) {
  EXPECT_FALSE(outcome_of(side_by_side({.extra_width_m = 0.1}), "reckless").violation);
  EXPECT_TRUE(outcome_of(side_by_side({.extra_width_m = 0.4}), "reckless").violation);
  const Outcome sound = outcome_of(side_by_side({.extra_width_m = 0.4}), "hull-lock");
  EXPECT_FALSE(sound.violation) << "it does not pick without room for the loaded body";
  EXPECT_EQ(sound.counters.transports_done, 0U);
  EXPECT_EQ(outcome_of(side_by_side({.extra_width_m = 0.1}), "hull-lock").counters.transports_done, 1U);
}

TEST(StartRoom, TheValidatorMeasuresLoadedBodies) {
  EXPECT_TRUE(problems_of(side_by_side({})).empty());
  EXPECT_TRUE(problems_of(side_by_side({.extra_width_m = 0.15})).empty()) << "exactly the safety distance";
  const auto problems = problems_of(side_by_side({.extra_width_m = 0.16}));
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].kind, ProblemKind::StartsTooClose);
  EXPECT_EQ(problems[0].sentence,
            "\"never moves\" starts closer than 0.1 m to \"picks\" once loaded; choose another start");
}

TEST(StartRoom, TheValidatorMeasuresLoadedBodiesBesideObstacles) {
  Scenario s = side_by_side({.extra_width_m = 0.1});
  s.obstacles.push_back({"pallet", {1.0, 1.0}, {{0.0, -1.12}, Vec2::UnitX()}});
  const auto problems = problems_of(s);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].kind, ProblemKind::StartNearObstacle);
  EXPECT_EQ(problems[0].sentence, "\"picks\" starts closer than 0.1 m to obstacle \"pallet\" once loaded; move one");
  s.vehicle_types[0].loaded = {};
  EXPECT_TRUE(problems_of(s).empty()) << "the empty body has room";
}

std::vector<std::string> all_ranges() {
  std::vector<std::string> names;
  for (const auto& family : layout_families()) {
    names.emplace_back(family.name);
    names.push_back(family_name(family.name, Range::Stress));
  }
  return names;
}

class StartRoomInFamily : public testing::TestWithParam<std::string> {};

TEST_P(StartRoomInFamily, EveryPlacementLeavesRoomForTheLoadedBody) {
  WorldSpec spec;
  spec.layout = GetParam();
  spec.vehicles[0].type.loaded = kWide;
  RejectionCounts counts;
  for (const auto placement : kPlacements) {
    spec.placement = placement;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
      const Scenario s = generate_world(spec, seed, counts);
      EXPECT_TRUE(problems_of(s).empty()) << name_of(placement) << " " << seed;
      ASSERT_GE(smallest_gap_m(s), 0.1 - 1e-5) << name_of(placement) << " " << seed;
    }
  }
}

// The short type grows along, the wide type grows across; each start has room for both before types are drawn.
TEST_P(StartRoomInFamily, AMixedFleetStartsWithRoomForTheLargestOfItsTypes) {
  WorldSpec spec;
  spec.layout = GetParam();
  VehicleType wide = spec.vehicles[0].type;
  spec.vehicles[0].type.loaded = {.extra_length_m = 0.5};
  wide.name = "wide";
  wide.loaded = {.extra_width_m = 0.3};
  spec.vehicles.push_back({wide, 1.0});
  spec.placement = Placement::ChargerBank;
  RejectionCounts counts;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Scenario s = generate_world(spec, seed, counts);
    for (VehicleType& type : s.vehicle_types) type.loaded = {.extra_length_m = 0.5, .extra_width_m = 0.3};
    ASSERT_GE(smallest_gap_m(s), 0.1 - 1e-5) << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(All, StartRoomInFamily, testing::ValuesIn(all_ranges()), [](const auto& test) {
  std::string name = test.param;
  for (char& c : name) c = c == '-' || c == '/' ? '_' : c;
  return name;
});

// The room that layout_family.hpp promises at places to wait is enough for a loaded body too: turned in any way, it
// leaves every lane free that does not end there.
class WaitingRoomInFamily : public testing::TestWithParam<Entry<MakeLayout>> {};

TEST_P(WaitingRoomInFamily, ALoadedAgvThatWaitsLeavesTheOtherLanesFree) {
  const Footprint empty;
  const double length_m = empty.length_m + kWide.extra_length_m, width_m = empty.width_m + kWide.extra_width_m;
  const double reach_m = 0.5 * std::sqrt(length_m * length_m + width_m * width_m);
  for (std::uint64_t seed = 0; seed < independent::seed_count() / 3; ++seed) {
    Draws draws(stream_key(seed, Stream::Layout));
    const Layout layout = GetParam().make(draws, Range::Normal);
    for (std::size_t i = 0; i < layout.stations.size(); ++i) {
      const Station& station = layout.stations[i];
      if (!is_place_to_wait(station)) continue;
      for (const Segment& segment : layout.segments) {
        if (segment.from == StationId{i} || segment.to == StationId{i}) continue;
        const double apart_m = independent::distance_to_segment_m(layout, segment, station.position_m);
        ASSERT_GE(apart_m, reach_m + 0.5 * width_m + 0.1) << seed << ": " << station.name << ", " << segment.name;
      }
    }
  }
}

std::vector<Entry<MakeLayout>> families_with_room_to_wait() {
  std::vector<Entry<MakeLayout>> families(layout_families().begin(), layout_families().end());
  std::erase_if(families, [](const auto& family) { return family.name == "plant"; });  // goods stand in its aisles
  return families;
}

INSTANTIATE_TEST_SUITE_P(All, WaitingRoomInFamily, testing::ValuesIn(families_with_room_to_wait()),
                         [](const auto& test) {
                           std::string name(test.param.name);
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

}  // namespace
}  // namespace fleetproof::start_room_test
