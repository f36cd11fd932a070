#include "generators/worlds/world_maker.hpp"

#include <gtest/gtest.h>

#include <iostream>
#include <set>

#include "core/base/error.hpp"
#include "core/base/random.hpp"
#include "generators/families/layout_family.hpp"
#include "generators/scenario_file/scenario_file.hpp"
#include "generators/scenario_file/scenario_text.hpp"
#include "generators/scenario_file/validator.hpp"
#include "independent_check.hpp"

namespace fleetproof::world_maker_test {
namespace {

Scenario world(const WorldSpec& spec, std::uint64_t seed) {
  RejectionCounts counts;
  return generate_world(spec, seed, counts);
}

// Names of what an AGV is told, so that scenarios can be compared.
std::string told(const Scenario& s, const AgvSetup& agv) {
  std::string text = agv.name + " at " + s.map->station(agv.start).name;
  for (const auto& t : agv.transports)
    text +=
        " " + s.map->station(t.from).name + ">" + s.map->station(t.to).name + "@" + std::to_string(t.release.count());
  return text;
}

std::shared_ptr<const LogicalMap> two_station_map(Purposes purposes) {
  Layout layout;
  layout.name = "pair";
  layout.stations = {{"a", {0, 0}, purposes}, {"b", {4, 0}, purposes}};
  layout.segments = {{"a-b", StationId{0U}, StationId{1U}, true, {}}};
  return std::make_shared<const LogicalMap>(layout);
}

// Families, normal and under stress.
std::vector<std::string> all_ranges() {
  std::vector<std::string> names;
  for (const auto& family : layout_families()) {
    names.emplace_back(family.name);
    names.push_back(family_name(family.name, Range::Stress));
  }
  return names;
}

void expect_sound(const WorldSpec& spec, const Scenario& s) {
  ASSERT_TRUE(problems_of(s).empty()) << s.seed;
  ASSERT_EQ(s.agvs.size(), spec.fleet_size);
  const Layout& layout = s.map->layout();
  const auto reach = independent::reach(layout);
  std::vector<independent::Corners> bodies;
  for (const auto& agv : s.agvs) {
    bodies.push_back(
        independent::corners(layout.stations[agv.start.index()].position_m, agv.heading, s.vehicle_types[0].footprint));
    Duration last{};
    ASSERT_FALSE(agv.transports.empty());
    EXPECT_LT(agv.transports[0].release, std::chrono::seconds(10));
    for (const auto& t : agv.transports) {
      EXPECT_NE(t.from, t.to);
      EXPECT_TRUE(layout.stations[t.from.index()].purposes.has(Purpose::Storage));
      EXPECT_TRUE(layout.stations[t.to.index()].purposes.has(Purpose::Storage));
      EXPECT_TRUE(reach[agv.start.index()][t.from.index()] && reach[t.from.index()][t.to.index()] &&
                  reach[t.to.index()][t.from.index()]);
      EXPECT_GE(t.release, last);
      EXPECT_LT(t.release, s.horizon);
      last = t.release;
    }
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) ASSERT_GE(independent::gap_m(bodies[i], bodies[k]), 0.1 - 1e-5) << s.seed;
  }
}

void print_rejections(const std::string& name, const RejectionCounts& counts) {
  std::string reasons;
  for (std::size_t i = 0; i < kProblemKinds; ++i) {
    if (counts.reasons[i] > 0)
      reasons += std::string(", ") + name_of(static_cast<ProblemKind>(i)) + " " + std::to_string(counts.reasons[i]);
  }
  std::cout << name << ": " << counts.worlds << " worlds, " << counts.worlds_rejected << " more drawn and refused, "
            << counts.starts_tried << " starts tried" << reasons << "\n";
}

class GenerateWorld : public testing::TestWithParam<std::string> {};

TEST_P(GenerateWorld, IsSoundByAnIndependentJudge) {
  WorldSpec spec;
  spec.layout = GetParam();
  RejectionCounts counts;
  for (std::uint64_t seed = 0; seed < independent::seed_count(); ++seed) {
    spec.fleet_size = 1 + static_cast<std::uint32_t>(seed % 12);
    const Scenario s = generate_world(spec, seed, counts);
    EXPECT_EQ(s.seed, seed);
    expect_sound(spec, s);
    if (HasFatalFailure()) return;
  }
  print_rejections(GetParam(), counts);
}

TEST_P(GenerateWorld, AgvsHeadAlongALaneThatLeavesTheirStation) {
  const bool stress = GetParam().ends_with(kStressSuffix);
  WorldSpec spec;
  spec.layout = GetParam();
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Scenario s = world(spec, seed);
    for (const auto& agv : s.agvs) {
      bool along = false;
      for (const auto lane : s.map->lanes_from(agv.start))
        along |= (s.map->lanes()[lane].curve.pose_at(0.0).heading - agv.heading).norm() < 1e-12;
      EXPECT_TRUE(along) << seed << " " << agv.name;
      if (stress) continue;  // a stress layout may have fewer places to wait
      EXPECT_NE(s.map->station(agv.start).purposes, Purposes(Purpose::Routing)) << "five AGVs find a place to wait";
    }
  }
}

TEST_P(GenerateWorld, SameSeedSameTextOtherSeedOtherText) {
  WorldSpec spec;
  spec.layout = GetParam();
  std::set<std::string> texts;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto text = to_text(world(spec, seed));
    EXPECT_EQ(text, to_text(world(spec, seed)));
    texts.insert(text);
  }
  EXPECT_EQ(texts.size(), 20U);
}

INSTANTIATE_TEST_SUITE_P(All, GenerateWorld, testing::ValuesIn(all_ranges()), [](const auto& test) {
  std::string name = test.param;
  for (char& c : name) c = c == '-' || c == '/' ? '_' : c;
  return name;
});

TEST(WorldStreams, MoreAgvsOrALongerHorizonLeaveTheRestAsItWas) {
  WorldSpec spec, more, longer;
  more.fleet_size = 9;
  longer.horizon = std::chrono::seconds(1200);
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const Scenario a = world(spec, seed), b = world(more, seed), c = world(longer, seed);
    for (std::size_t i = 0; i < a.agvs.size(); ++i) {
      EXPECT_EQ(told(a, a.agvs[i]), told(b, b.agvs[i])) << seed;
      EXPECT_TRUE(told(c, c.agvs[i]).starts_with(told(a, a.agvs[i]))) << seed;
    }
  }
}

TEST(WorldStreams, TheRateOfTransportsMovesNoAgv) {
  WorldSpec spec, none;
  none.demand.transports_per_agv_hour = 0.0;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const Scenario a = world(spec, seed), b = world(none, seed);
    EXPECT_EQ(a.map->layout().stations.size(), b.map->layout().stations.size());
    for (std::size_t i = 0; i < a.agvs.size(); ++i) {
      EXPECT_EQ(a.agvs[i].start, b.agvs[i].start);
      EXPECT_EQ(a.agvs[i].heading, b.agvs[i].heading);
      EXPECT_TRUE(b.agvs[i].transports.empty());
    }
  }
}

TEST(WorldStreams, TransportsArePoissonAfterTheFirst) {
  WorldSpec spec;
  spec.demand.transports_per_agv_hour = 60.0;
  spec.horizon = std::chrono::seconds(3600);
  double count = 0.0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    for (const auto& agv : world(spec, seed).agvs) count += static_cast<double>(agv.transports.size()) - 1.0;
  }
  // 200 AGV-hours, less the 5 s before the first on average: 11 983 expected, standard deviation 110.
  EXPECT_NEAR(count, 11'983.0, 550.0);
}

TEST(WorldOnAFixedMap, SharesTheMapAndDrawsTheRest) {
  WorldSpec spec;
  Draws draws(1);
  const auto map = std::make_shared<const LogicalMap>(layout_families()[0].make(draws, Range::Normal));
  spec.layout = map;
  RejectionCounts counts;
  const Scenario a = generate_world(spec, 1, counts), b = generate_world(spec, 2, counts);
  EXPECT_EQ(a.map, map);
  EXPECT_EQ(b.map, map);
  EXPECT_NE(told(a, a.agvs[0]), told(b, b.agvs[0]));
  EXPECT_EQ(counts.worlds, 2U);
  EXPECT_EQ(counts.starts_tried, 10U);
}

TEST(WorldOnAFixedMap, WithoutStorageAnyStationsServeAndItIsCounted) {
  WorldSpec spec;
  spec.layout = two_station_map(Purpose::Routing);
  spec.fleet_size = 1;
  RejectionCounts counts;
  const Scenario s = generate_world(spec, 1, counts);
  EXPECT_EQ(counts.worlds_without_storage, 1U);
  EXPECT_FALSE(s.agvs[0].transports.empty());
}

std::string refusal(const WorldSpec& spec) {
  RejectionCounts counts;
  try {
    generate_world(spec, 1, counts);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(WorldRefusals, NameFieldAndRemedy) {
  WorldSpec empty, rate, time, family, crowd, narrow, vehicle;
  empty.fleet_size = 0;
  rate.demand.transports_per_agv_hour = -1.0;
  time.horizon = Duration::zero();
  family.layout = std::string("aisle");
  crowd.fleet_size = 1000;
  narrow.layout = two_station_map(Purpose::Parking);
  narrow.fleet_size = 3;
  vehicle.vehicles[0].type.footprint.width_m = -1.0;
  EXPECT_NE(refusal(empty).find("fleet_size"), std::string::npos);
  EXPECT_NE(refusal(rate).find("transports_per_agv_hour"), std::string::npos);
  EXPECT_NE(refusal(time).find("horizon"), std::string::npos);
  EXPECT_NE(refusal(family).find("known: aisle-grid"), std::string::npos) << refusal(family);
  EXPECT_NE(refusal(crowd).find("cannot place 1000 AGVs"), std::string::npos) << refusal(crowd);
  EXPECT_NE(refusal(narrow).find("2 fit on \"pair\", but with more than one for two "
                                 "stations a fleet may stand still: ask for 1 or fewer"),
            std::string::npos)
      << refusal(narrow);
  EXPECT_NE(refusal(vehicle).find("width_m"), std::string::npos) << refusal(vehicle);
}

// The numbers in the refusal fit in other worlds, too, and how many fit is not far too small: twice as many do not.
TEST(WorldRefusals, SayHowManyAgvsFit) {
  for (const char* layout : {"corridor-sidings", "loop-spurs", "plant/60", "plant/stress/200"}) {
    WorldSpec spec;
    spec.layout = std::string(layout);
    spec.fleet_size = 400;
    const std::string text = refusal(spec);
    const auto at = text.find("ask for "), before = text.find("; ");
    ASSERT_NE(at, std::string::npos) << text;
    EXPECT_NE(text.find("fit on \"" + std::string(layout).substr(0, 5)), std::string::npos) << text;
    const auto fits = static_cast<std::uint32_t>(std::stoul(text.substr(before + 2))),
               wise = static_cast<std::uint32_t>(std::stoul(text.substr(at + 8)));
    ASSERT_GE(wise, 5U) << text;
    ASSERT_LE(wise, fits) << text;
    RejectionCounts counts;
    spec.fleet_size = fits;
    for (std::uint64_t seed = 100; seed < 120; ++seed) {
      const Scenario world = generate_world(spec, seed, counts);
      EXPECT_EQ(world.agvs.size(), fits);
      EXPECT_TRUE(problems_of(world).empty());
    }
    spec.fleet_size = 2 * fits;
    EXPECT_THROW(generate_world(spec, 100, counts), InputError) << layout << " " << fits;
  }
}

TEST(WorldRefusals, AMapWithoutWaysBackIsNamed) {
  WorldSpec spec;
  Layout layout = two_station_map(Purpose::Storage)->layout();
  layout.segments[0].bidirectional = false;
  spec.layout = std::make_shared<const LogicalMap>(layout);
  spec.fleet_size = 1;
  EXPECT_NE(refusal(spec).find("only 1 of 2 stations"), std::string::npos) << refusal(spec);
}

TEST(WorldRejections, ALongVehicleIsTurnedAwayFromNeighbouringStations) {
  WorldSpec spec;
  spec.vehicles[0].type.footprint = {3.9, 3.0};  // neighbours 3-4.6 m away are out of the question
  spec.fleet_size = 8;
  RejectionCounts counts;
  for (std::uint64_t seed = 0; seed < 20; ++seed) EXPECT_TRUE(problems_of(generate_world(spec, seed, counts)).empty());
  EXPECT_GT(counts.of(ProblemKind::StartsTooClose), 0U);
  EXPECT_EQ(counts.worlds_rejected, 0U) << "the next station was tried, not the next world";
  EXPECT_EQ(counts.worlds, 20U);
}

}  // namespace
}  // namespace fleetproof::world_maker_test
