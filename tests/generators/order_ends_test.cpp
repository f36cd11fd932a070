// Worlds in a plant where AGVs only pick at one station, only drop at another, and charge without a load.
#include <gmock/gmock.h>

#include <map>
#include <set>

#include "core/base/error.hpp"
#include "generators/map/core_only.hpp"
#include "generators/worlds/encounter_pairs.hpp"
#include "generators/worlds/order_list.hpp"
#include "generators/worlds/transports.hpp"
#include "generators/worlds/world_maker.hpp"
#include "tests/support/source_and_sink.hpp"

namespace fleetproof::order_ends_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> names(const LogicalMap& map, const std::vector<StationId>& stations) {
  std::vector<std::string> all;
  for (const StationId station : stations) all.push_back(map.station(station).name);
  return all;
}

TEST(OrderEnds, AreWhereThePlantPermitsPicksAndDrops) {
  const LogicalMap map(test::source_and_sink());
  const Reachability reachability(map);
  const OrderEnds ends = order_ends(map, reachability);
  EXPECT_THAT(names(map, ends.picks), ElementsAre("source", "shelf"));
  EXPECT_THAT(names(map, ends.drops), ElementsAre("sink", "shelf"));
  EXPECT_TRUE(ends.storage);
  EXPECT_EQ(reachability.core().size(), map.station_count());
  EXPECT_THAT(names(map, reachability.starts()),
              ElementsAre("r0", "r1", "r2", "r3", "r4", "r5", "sink", "charger", "shelf"));
}

TEST(OrderEnds, EveryPickHasAnotherDrop) {
  Layout layout = test::source_and_sink();
  layout.stations[6].purposes = Purpose::Routing;  // what is left are a sink and a shelf
  const LogicalMap map(layout);
  const OrderEnds ends = order_ends(map, Reachability(map));
  EXPECT_THAT(names(map, ends.picks), ElementsAre("shelf"));
  layout.stations[7].purposes = Purpose::Routing;
  const LogicalMap shelf(layout);
  EXPECT_FALSE(order_ends(shelf, Reachability(shelf)).storage) << "from the shelf to the shelf is no transport";
  layout.stations[6].purposes = layout.stations[7].purposes = Purpose::Storage;
  layout.stations[9].purposes = Purpose::Routing;
  const LogicalMap two(layout);
  const OrderEnds one_way = order_ends(two, Reachability(two));
  EXPECT_THAT(names(two, one_way.picks), ElementsAre("source"));
  EXPECT_THAT(names(two, one_way.drops), ElementsAre("sink"));
}

TEST(OrderEnds, HoldForEveryPlacementAndDemand) {
  WorldSpec spec;
  spec.layout = std::make_shared<const LogicalMap>(test::source_and_sink());
  spec.fleet_size = 2;
  std::map<std::string, int> orders;
  std::set<std::string> starts;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    spec.placement = kPlacements[seed % kPlacements.size()];
    spec.demand = {120.0, seed % 2 == 0 ? 0.0 : 2.0};
    RejectionCounts counts;
    const Scenario s = generate_world(spec, seed, counts);
    for (const AgvSetup& agv : s.agvs) {
      starts.insert(s.map->station(agv.start).name);
      for (const auto& order : agv.transports)
        ++orders[s.map->station(order.from).name + " to " + s.map->station(order.to).name];
    }
  }
  EXPECT_EQ(orders.size(), 3U);
  for (const char* order : {"source to sink", "source to shelf", "shelf to sink"})
    EXPECT_GT(orders[order], 300) << order;
  EXPECT_FALSE(starts.contains("source"));
  EXPECT_TRUE(starts.contains("sink") && starts.contains("charger") && starts.contains("shelf"));
}

TEST(OrderEnds, HoldForPairsThatAreSentToMeet) {
  const Layout layout = test::source_and_sink();
  Scenario scenario;
  scenario.map = std::make_shared<const LogicalMap>(layout);
  scenario.horizon = std::chrono::minutes(1);
  const StationId source{6U}, sink{7U}, shelf{9U};
  const OrderEnds ends{{source, shelf}, {sink, shelf}, {}, true};
  scenario.agvs.resize(2);
  scenario.agvs[0].transports = {{source, shelf, Duration{}}};
  scenario.agvs[1].transports = {{shelf, sink, Duration{}}};
  send_to_meet(scenario, {{0, 1, shelf, source, Duration{}}}, {ends});
  EXPECT_EQ(scenario.agvs[0].transports[0].from, shelf);
  EXPECT_EQ(scenario.agvs[0].transports[0].to, sink) << "nothing can be dropped at the source";
  EXPECT_EQ(scenario.agvs[1].transports[0].from, source);
  EXPECT_EQ(scenario.agvs[1].transports[0].to, sink);
  scenario.agvs[1].transports = {{shelf, sink, Duration{}}};
  send_to_meet(scenario, {{0, 1, shelf, sink, Duration{}}}, {ends});
  EXPECT_EQ(scenario.agvs[1].transports[0].to, shelf) << "to and fro, as before";
}

// With a skew, the busiest of two sources is 2^skew times as busy as the other.
TEST(OrderEnds, ShareTheTrafficAmongPicksAndAmongDrops) {
  WorldSpec spec;
  spec.layout = std::make_shared<const LogicalMap>(test::source_and_sink());
  spec.fleet_size = 1;
  spec.demand = {3600.0, 1.0};
  spec.horizon = std::chrono::hours(5);
  const double shares[] = {1.0, 1.0 / 2.0, 1.0 / 3.0};  // of source, sink and shelf, in a drawn order
  std::set<std::size_t> seen;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    RejectionCounts counts;
    const Scenario s = generate_world(spec, seed, counts);
    double of_source = 0.0;
    for (const auto& order : s.agvs[0].transports)
      of_source +=
          (s.map->station(order.from).name == "source" ? 1.0 : 0.0) / static_cast<double>(s.agvs[0].transports.size());
    std::size_t ranks = 0, nearest = 0;
    double off = 1.0;
    for (const double source : shares) {
      for (const double shelf : shares) {
        ++ranks;
        if (source == shelf || std::abs(of_source - source / (source + shelf)) > off) continue;
        off = std::abs(of_source - source / (source + shelf));
        nearest = ranks;
      }
    }
    EXPECT_LT(off, 0.02) << seed;
    seen.insert(nearest);
  }
  EXPECT_EQ(seen.size(), 6U);
}

TEST(OrderEnds, AreThoseOfEachMutation) {
  Layout layout = test::source_and_sink();
  layout.segments.back().permissions = {{"", LoadState::Loaded}};  // the shelf becomes a source, too: one sink is left
  WorldSpec spec;
  spec.layout = std::make_shared<const LogicalMap>(layout);
  spec.mutate = true;
  spec.fleet_size = 1;
  RejectionCounts counts;
  int mutations = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const Scenario s = generate_world(spec, seed, counts);
    const OrderEnds ends = order_ends(*s.map, Reachability(*s.map));
    mutations += s.map->layout().segments.size() != layout.segments.size() ? 1 : 0;
    ASSERT_FALSE(s.agvs[0].transports.empty()) << seed;
    for (const auto& order : s.agvs[0].transports) {
      EXPECT_TRUE(std::ranges::binary_search(ends.picks, order.from)) << seed;
      EXPECT_TRUE(std::ranges::binary_search(ends.drops, order.to)) << seed;
    }
  }
  EXPECT_GT(mutations, 30);
}

// A row of stations for AGVs without a load, and one lane for loads. Without that lane, no transport is possible.
TEST(OrderEnds, AMutationThatLeavesNoneIsDrawnAgain) {
  Layout layout;
  layout.name = "row";
  layout.floor_high_m = {50.0, 5.0};
  for (std::uint32_t i = 0; i < 12; ++i) layout.stations.push_back({std::to_string(i), {4.0 * i, 0.0}});
  for (std::uint32_t i = 0; i < 11; ++i) {
    layout.segments.push_back({"e" + std::to_string(i), StationId{i}, StationId{i + 1}, true});
    layout.segments.back().permissions = {{"", LoadState::Empty}};
  }
  layout.segments.push_back({"loads", StationId{5U}, StationId{6U}, false});
  layout.segments.back().control_points_m = {{21.0, 2.0}, {23.0, 2.0}};
  layout.segments.back().permissions = {{"", LoadState::Loaded}};
  WorldSpec spec;
  spec.layout = std::make_shared<const LogicalMap>(layout);
  spec.mutate = true;
  spec.fleet_size = 1;
  RejectionCounts counts;
  for (std::uint64_t seed = 0; seed < 100; ++seed)
    EXPECT_FALSE(generate_world(spec, seed, counts).agvs[0].transports.empty()) << seed;
  EXPECT_GT(counts.of(ProblemKind::WeakCore), 0U);
}

// A ring for all; spurs for forklifts at one side, for tuggers at the other.
Layout two_halves() {
  Layout layout = test::source_and_sink();
  layout.segments.resize(6);
  layout.stations.resize(6);
  for (std::uint32_t i = 0; i < 6; ++i) {
    const Vec2 at = layout.stations[i].position_m;
    layout.stations.push_back({"spur " + std::to_string(i), {at.x(), at.y() < 4.0 ? -6.0 : 14.0}, Purpose::Storage});
    layout.segments.push_back({"s" + std::to_string(i), StationId{i}, StationId{i + 6}, true});
    layout.segments.back().permissions = {{i < 3 ? "forklift" : "tugger", LoadState::Any}};
  }
  return layout;
}

std::vector<VehicleShare> forklift_and_tugger() {
  std::vector<VehicleShare> vehicles(2);
  vehicles[0].type.name = "forklift";
  vehicles[1].type.name = "tugger";
  return vehicles;
}

TEST(MixedFleets, EachTypeStartsAndCarriesWhereItMay) {
  WorldSpec spec;
  spec.layout = std::make_shared<const LogicalMap>(two_halves());
  spec.fleet_size = 4;
  spec.demand.transports_per_agv_hour = 120.0;
  spec.vehicles = forklift_and_tugger();
  std::map<std::uint32_t, std::set<std::uint32_t>> starts, ends;  // by type: spurs
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    spec.placement = kPlacements[seed % kPlacements.size()];
    spec.demand.hot_spot_skew = seed % 2 == 0 ? 0.0 : 1.0;
    RejectionCounts counts;
    const Scenario s = generate_world(spec, seed, counts);
    for (const AgvSetup& agv : s.agvs) {
      if (agv.start.value >= 6) starts[agv.type].insert(agv.start.value);
      EXPECT_FALSE(agv.transports.empty());
      for (const auto& order : agv.transports) ends[agv.type].insert({order.from.value, order.to.value});
    }
  }
  const std::set<std::uint32_t> forklift = {6, 7, 8}, tugger = {9, 10, 11};
  EXPECT_EQ(starts[0], forklift);
  EXPECT_EQ(starts[1], tugger);
  EXPECT_EQ(ends[0], forklift);
  EXPECT_EQ(ends[1], tugger);
}

// Places to wait come first. A place that is not for one type stays free for the others.
TEST(MixedFleets, NoTypeTakesAPlaceFromAnother) {
  const std::vector<std::string> names = {"forklift", "tugger"};
  const std::vector<std::uint32_t> types = {0, 0, 0, 1, 1, 1};
  Scenario scenario;
  scenario.map = std::make_shared<const LogicalMap>(two_halves());
  scenario.vehicle_types = {VehicleType{}};
  const Reachability reachability(*scenario.map, names);
  for (std::uint64_t key = 0; key < 50; ++key) {
    RejectionCounts counts;
    scenario.agvs.clear();
    ASSERT_TRUE(place_fleet(scenario, types, reachability, key, 0, counts));
    for (std::size_t i = 0; i < types.size(); ++i) {
      EXPECT_GE(scenario.agvs[i].start.value, types[i] == 0 ? 6U : 9U) << key;
      EXPECT_LT(scenario.agvs[i].start.value, types[i] == 0 ? 9U : 12U) << key;
    }
  }
}

// The bank leaves the stations of a type to the AGVs of it, wherever in the fleet they come.
TEST(MixedFleets, AChargerBankTakesNoPlaceFromAType) {
  const std::vector<std::string> names = {"forklift", "tugger"};
  std::vector<std::uint32_t> types(9, 0);  // as many as the ring and the spurs of forklifts have room for
  types.resize(12, 1);
  Scenario scenario;
  scenario.map = std::make_shared<const LogicalMap>(two_halves());
  scenario.vehicle_types = {VehicleType{}};
  const Reachability reachability(*scenario.map, names);
  for (std::uint64_t key = 0; key < 50; ++key) {
    RejectionCounts counts;
    scenario.agvs.clear();
    ASSERT_TRUE(place_at_charger_bank(scenario, types, reachability, key, 0, counts)) << scenario.agvs.size();
    for (std::size_t i = 9; i < types.size(); ++i) EXPECT_GE(scenario.agvs[i].start.value, 9U) << key;
  }
}

TEST(MixedFleets, ListedOrdersAreJudgedByTheTypeOfTheirAgv) {
  WorldSpec spec;
  spec.layout = std::make_shared<const LogicalMap>(two_halves());
  spec.fleet_size = 2;
  spec.vehicles = forklift_and_tugger();
  spec.orders =
      std::make_shared<const OrderList>(parse_order_list("release_s,from,to,agv\n1,spur 0,spur 1,0\n", "o.csv"));
  int accepted = 0, refused = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    RejectionCounts counts;
    try {
      EXPECT_EQ(generate_world(spec, seed, counts).agvs[0].type, 0U);
      ++accepted;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("o.csv:2: from is \"spur 0\""));
      ++refused;
    }
  }
  EXPECT_GT(accepted, 3);
  EXPECT_GT(refused, 3);
}

TEST(MixedFleets, ATypeThatCannotCarryIsNamed) {
  Layout layout = two_halves();
  for (std::size_t i = 9; i < 12; ++i) layout.segments[i].permissions = {{"forklift", LoadState::Any}};
  for (std::size_t i = 0; i < 6; ++i)
    layout.segments[i].permissions = {{"forklift", LoadState::Any}, {"tugger", LoadState::Empty}};
  WorldSpec spec;
  spec.layout = std::make_shared<const LogicalMap>(layout);
  spec.fleet_size = 2;
  spec.vehicles = forklift_and_tugger();
  RejectionCounts counts;
  EXPECT_THAT([&] { generate_world(spec, 1, counts); },
              testing::ThrowsMessage<InputError>(HasSubstr("no AGV of type \"tugger\" can pick a load")));
}

TEST(OrderEnds, AListMustRespectThem) {
  WorldSpec spec;
  spec.layout = std::make_shared<const LogicalMap>(test::source_and_sink());
  spec.fleet_size = 1;
  const auto refusal = [&](const std::string& order) -> std::string {
    spec.orders =
        std::make_shared<const OrderList>(parse_order_list("release_s,from,to\n1," + order + "\n", "orders.csv"));
    RejectionCounts counts;
    try {
      generate_world(spec, 1, counts);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refusal("source,sink"), "accepted");
  const char* rest = " a load there (turns, headings, loads and types); choose another station";
  EXPECT_THAT(refusal("sink,shelf"),
              HasSubstr(std::string("orders.csv:2: from is \"sink\", but the layout does not permit "
                                    "an AGV of this type to pick") +
                        rest));
  EXPECT_THAT(refusal("shelf,source"), HasSubstr(std::string("orders.csv:2: to is \"source\", but the layout does not "
                                                             "permit an AGV of this type to drop") +
                                                 rest));
}

// Two rows of stations; between them, AGVs drive without a load alone.
Layout two_halls() {
  Layout layout;
  layout.name = "halls";
  layout.floor_high_m = {20.0, 20.0};
  for (std::uint32_t i = 0; i < 6; ++i)
    layout.stations.push_back({std::to_string(i), {6.0 * (i % 3), i < 3 ? 0.0 : 8.0}, Purpose::Storage});
  for (const auto& [from, to] : {std::pair(0U, 1U), {1U, 2U}, {3U, 4U}, {4U, 5U}, {2U, 5U}})
    layout.segments.push_back({std::to_string(from) + "-" + std::to_string(to), StationId{from}, StationId{to}, true});
  layout.segments.back().permissions = {{"", LoadState::Empty}};
  return layout;
}

TEST(OrderEnds, EachHallHasItsOwnOrders) {
  WorldSpec spec;
  spec.layout = std::make_shared<const LogicalMap>(two_halls());
  spec.fleet_size = 1;
  spec.demand.transports_per_agv_hour = 120.0;
  int halls[2] = {0, 0};
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    spec.demand.hot_spot_skew = seed % 2 == 0 ? 0.0 : 2.0;
    spec.placement = kPlacements[seed % kPlacements.size()];
    RejectionCounts counts;
    const Scenario s = generate_world(spec, seed, counts);
    for (const auto& order : s.agvs[0].transports) {
      EXPECT_EQ(order.from.value / 3, order.to.value / 3) << "no load gets through the door";
      EXPECT_NE(order.from, order.to);
      ++halls[order.from.value / 3];
    }
  }
  EXPECT_GT(std::min(halls[0], halls[1]), 50);
  spec.placement = Placement::Random;
  spec.orders = std::make_shared<const OrderList>(parse_order_list("release_s,from,to\n1,0,2\n2,0,4\n", "o.csv"));
  RejectionCounts counts;
  EXPECT_THAT([&] { generate_world(spec, 1, counts); },
              testing::ThrowsMessage<InputError>(
                  HasSubstr("o.csv:3: no way leads from \"0\" to \"4\" for an AGV with a load")));
}

TEST(OrderEnds, APlantWithoutAnyIsRefused) {
  Layout layout = test::source_and_sink();
  for (Segment& segment : layout.segments) segment.permissions = {{"", LoadState::Empty}};
  WorldSpec spec;
  spec.layout = std::make_shared<const LogicalMap>(layout);
  spec.fleet_size = 1;
  RejectionCounts counts;
  EXPECT_THAT([&] { generate_world(spec, 1, counts); },
              testing::ThrowsMessage<InputError>(HasSubstr("can pick a load at one station and drop it at "
                                                           "another by what the layout permits")));
  spec.demand.transports_per_agv_hour = 0.0;
  EXPECT_NO_THROW(generate_world(spec, 1, counts));
}

TEST(LimitedUses, AreToldByName) {
  Layout layout = test::source_and_sink();
  EXPECT_THAT(limited_uses(layout),
              ElementsAre(HasSubstr("orders begin and do not end"), HasSubstr("orders end and do not begin")));
  EXPECT_EQ(reachability_text(layout), "all 10 stations can be reached and left");
  layout.stations[8].heading = Vec2(0.0, 1.0);
  layout.stations[9].heading = Vec2(0.0, 1.0);
  EXPECT_THAT(limited_uses(layout),
              ElementsAre(HasSubstr("source"), HasSubstr("sink"),
                          HasSubstr("neither begin nor end at some storage stations, by what the "
                                    "layout permits (turns, headings, loads): \"shelf\""),
                          HasSubstr("AGVs without a load do not get to some stations for charging "
                                    "or parking from everywhere, or not from there to "
                                    "everywhere, by what the layout permits (turns, headings, "
                                    "loads): \"charger\"")));
  for (Segment& segment : layout.segments) segment.permissions.clear();
  for (Station& station : layout.stations) station.heading.reset();
  EXPECT_TRUE(limited_uses(layout).empty());
}

}  // namespace
}  // namespace fleetproof::order_ends_test
