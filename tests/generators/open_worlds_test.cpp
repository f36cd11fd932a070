// Worlds whose transports are open, and transports that are withdrawn: what is drawn, and what stays as it was.
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>
#include <utility>
#include <vector>

#include "core/scenario/order_table.hpp"
#include "generators/scenario_file/scenario_text.hpp"
#include "generators/scenario_file/validator.hpp"
#include "generators/worlds/world_maker.hpp"
#include "tests/support/exact_binomial.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof::open_worlds_test {
namespace {

Scenario world(const WorldSpec& spec, std::uint64_t seed) {
  RejectionCounts counts;
  return generate_world(spec, seed, counts);
}

WorldSpec with(OrderKind kind, double withdrawn_share = 0.0) {
  WorldSpec spec;
  spec.order_setup = {kind, withdrawn_share};
  spec.horizon = seconds(1200.0);
  spec.faults.load_drops_per_transport = 0.3;
  spec.faults.breakdowns_per_transport = 0.3;
  spec.faults.breakdowns_per_agv_hour = 2.0;
  return spec;
}

using Line = std::tuple<Duration, std::uint32_t, std::uint32_t, Duration>;
Line line(const TransportOrder& order) { return {order.release, order.from.value, order.to.value, order.withdrawn}; }

TEST(OpenWorlds, HaveTheTransportsOfTheAssignedOnesInOrderOfRelease) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Scenario assigned = world(with(OrderKind::Assigned, 0.3), seed),
                   open = world(with(OrderKind::Open, 0.3), seed);
    std::vector<Line> given, left;
    for (const AgvSetup& agv : assigned.agvs) {
      for (const TransportOrder& order : agv.transports) given.push_back(line(order));
    }
    for (const TransportOrder& order : open.open_orders) left.push_back(line(order));
    EXPECT_TRUE(std::ranges::is_sorted(open.open_orders, {}, &TransportOrder::release));
    std::ranges::sort(given), std::ranges::sort(left);
    EXPECT_EQ(given, left);
    EXPECT_FALSE(given.empty());
    for (const AgvSetup& agv : open.agvs) EXPECT_TRUE(agv.transports.empty());
    EXPECT_TRUE(problems_of(open).empty());
  }
}

TEST(OpenWorlds, TheFaultsAtATransportStayWithIt) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Scenario assigned = world(with(OrderKind::Assigned), seed), open = world(with(OrderKind::Open), seed);
    const OrderTable of_assigned(assigned), of_open(open);
    ASSERT_EQ(assigned.faults.size(), open.faults.size());
    bool some = false;
    for (std::size_t i = 0; i < open.faults.size(); ++i) {
      const Fault &before = assigned.faults[i], &after = open.faults[i];
      EXPECT_EQ(std::tuple(before.kind, before.at, before.lasts), std::tuple(after.kind, after.at, after.lasts));
      EXPECT_EQ(before.transport.has_value(), after.transport.has_value());
      EXPECT_EQ(after.agv, before.transport ? AgvId{} : before.agv);
      if (!before.transport) continue;
      EXPECT_EQ(line(of_assigned.order(of_assigned.at(before.agv, *before.transport))),
                line(of_open.order(of_open.at({}, *after.transport))));
      some = true;
    }
    EXPECT_TRUE(some);
  }
}

TEST(OpenWorlds, ALoadFallsClearOfTheLongestAgv) {
  Scenario scenario = test::row_scenario(4, {0, 2});
  scenario.vehicle_types.push_back(scenario.vehicle_types[0]);
  scenario.vehicle_types[1].footprint.length_m += 1.0;
  scenario.agvs[1].type = 1;
  for (AgvSetup& agv : scenario.agvs) agv.transports = {{StationId{0U}, StationId{1U}, {}}};
  for (std::uint32_t agv = 0; agv < 2; ++agv) {
    Fault fall;
    fall.kind = Fault::Kind::LoadDrop;
    fall.agv = AgvId{agv};
    fall.transport = 0;
    fall.ahead_m = agv == 0 ? -2.0 : -2.5;
    scenario.faults.push_back(fall);
  }
  open_transports(scenario);
  EXPECT_DOUBLE_EQ(scenario.faults[0].ahead_m, -2.5);
  EXPECT_DOUBLE_EQ(scenario.faults[1].ahead_m, -2.5);
  EXPECT_EQ(scenario.faults[1].transport, 1U);
}

TEST(WithdrawnTransports, AreADrawnShareAndMoveNothingElse) {
  std::uint64_t all = 0, withdrawn = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const Scenario without = world(with(OrderKind::Assigned), seed);
    Scenario some = world(with(OrderKind::Assigned, 0.25), seed);
    for (AgvSetup& agv : some.agvs) {
      for (TransportOrder& order : agv.transports) {
        ++all;
        if (order.withdrawn == kLongestDuration) continue;
        ++withdrawn;
        EXPECT_GE(order.withdrawn, order.release);
        EXPECT_LE(order.withdrawn, order.release + seconds(300.0));
        order.withdrawn = kLongestDuration;
      }
    }
    EXPECT_EQ(text_without_layout(some), text_without_layout(without)) << "but for the withdrawals";
  }
  EXPECT_TRUE(test::is_binomial(withdrawn, all, 0.25));
}

TEST(WithdrawnTransports, OfAnAgvDoNotDependOnTheSizeOfTheFleet) {
  WorldSpec small = with(OrderKind::Assigned, 0.5), large = small;
  small.layout = large.layout = std::make_shared<const LogicalMap>(world(WorldSpec{}, 3).map->layout());
  small.fleet_size = 2, large.fleet_size = 5;
  const auto of = [](const Scenario& scenario) {
    std::vector<Line> lines;
    for (const TransportOrder& order : scenario.agvs[1].transports) lines.push_back(line(order));
    return lines;
  };
  EXPECT_EQ(of(world(small, 7)), of(world(large, 7)));
}

}  // namespace
}  // namespace fleetproof::open_worlds_test
