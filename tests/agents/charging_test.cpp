// hull-lock and its battery: when it drives to a charger, and when it leaves the charger to another AGV.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/agents/agent_type.hpp"
#include "tests/agents/junction.hpp"

namespace fleetproof::agents::charging_test {
namespace {

using testing::DrawnMap;
using testing::FakeWarehouse;
using testing::TestFleet;

// Stations 0 to 3 in a row, and a charger beside station 1.
struct Corridor {
  static constexpr std::uint32_t kCharger = 4;

  explicit Corridor(std::uint32_t purposes = FP_ROUTING) {
    for (int i = 0; i < 4; ++i) drawn.station(8.0 * i, 0, purposes);
    for (std::uint32_t i = 0; i < 3; ++i) drawn.segment(i, i + 1);
    drawn.station(8, 4, FP_CHARGING);
    drawn.segment(1, kCharger);
    drawn.map();
  }
  DrawnMap drawn;
};

TEST(Charging, AnEmptyAgvDrivesToTheChargerAndGoesOnAfterwards) {
  Corridor corridor;
  const TestFleet fleet(corridor.drawn.map(), 1);
  FakeWarehouse warehouse(corridor.drawn, fleet, {0}, kHullLock, {}, 1);
  warehouse.battery(0, 0.2);
  bool was_there = false;
  warehouse.after_activation = [&](std::uint32_t) {
    was_there = was_there || (warehouse.station_of(0) == Corridor::kCharger && warehouse.battery_of(0) > 0.85);
  };
  warehouse.order(0, 20.0, 0, 3);
  warehouse.run(300.0);
  EXPECT_TRUE(was_there);
  EXPECT_TRUE(warehouse.probes().contains("drives-to-charger"));
  EXPECT_EQ(warehouse.drops(), 1U);
  EXPECT_GE(warehouse.battery_of(0), 0.9);
}

// When it picks for the first time and what its battery then has.
double battery_at_the_first_pick(double battery, double restart_at_s, std::uint32_t from) {
  Corridor corridor;
  const TestFleet fleet(corridor.drawn.map(), 1);
  FakeWarehouse warehouse(corridor.drawn, fleet, {0}, kHullLock, {}, 1);
  warehouse.battery(0, battery);
  warehouse.order(0, 0.1, from, 2);
  if (restart_at_s > 0.0) warehouse.restart(0, restart_at_s, 1.0);
  double level = -1.0;
  warehouse.after_activation = [&](std::uint32_t) {
    const bool picks = !warehouse.calls().empty() && warehouse.calls().back().second == FP_CALL_PICK;
    if (level < 0.0 && picks) level = warehouse.battery_of(0);
  };
  warehouse.run(400.0);
  EXPECT_EQ(warehouse.drops(), 1U);
  return level;
}

TEST(Charging, ItLooksAtTheBatteryBeforeItSetsOutEvenAfterARestart) {
  EXPECT_GT(battery_at_the_first_pick(0.2, 0.0, 3), 0.8);
  EXPECT_GT(battery_at_the_first_pick(0.2, 1.0, 3), 0.8);
}

// Its battery gets low while it picks a load. The next load waits where it puts this one down.
double battery_at_the_next_pick(std::uint32_t where) {
  Corridor corridor(FP_STORAGE);
  const TestFleet fleet(corridor.drawn.map(), 1);
  FakeWarehouse warehouse(corridor.drawn, fleet, {0}, kHullLock, {}, 1);
  warehouse.battery(0, 1.0);
  warehouse.order(0, 0.1, 0, 3);
  warehouse.order(0, 0.1, 3, where);
  warehouse.order(0, 0.1, where, 2);
  std::int64_t picks = 0;
  double level = 0.0;
  warehouse.after_activation = [&](std::uint32_t) {
    const auto now = std::ranges::count(warehouse.calls(), FP_CALL_PICK, [](const auto& call) { return call.second; });
    if (now == 2 && picks == 1) warehouse.battery(0, 0.25);
    if (now == 3 && picks == 2) level = warehouse.battery_of(0);
    picks = now;
  };
  warehouse.run(400.0);
  EXPECT_EQ(warehouse.drops(), 3U);
  return level;
}

TEST(Charging, ItChargesBeforeItPicksWhereItHasJustDropped) {
  EXPECT_GT(battery_at_the_next_pick(0), 0.8);
  EXPECT_GT(battery_at_the_next_pick(1), 0.8) << "where it must not wait, it would go on at once";
}

TEST(Charging, AnAlmostEmptyAgvChargesWithItsLoad) {
  Corridor corridor;
  const TestFleet fleet(corridor.drawn.map(), 1);
  for (const bool almost_empty : {false, true}) {
    FakeWarehouse warehouse(corridor.drawn, fleet, {0}, kHullLock, {}, 1);
    warehouse.battery(0, 1.0);
    warehouse.order(0, 0.1, 0, 3);
    double level = 0.0;
    warehouse.after_activation = [&](std::uint32_t) {
      const bool picked = !warehouse.calls().empty() && warehouse.calls().back().first > 5.0;
      if (level == 0.0 && picked) warehouse.battery(0, almost_empty ? 0.08 : 0.25), level = 0.08;
      if (warehouse.calls().size() > 1 && warehouse.calls().back().second == FP_CALL_DROP)
        level = std::max(level, warehouse.battery_of(0));
    };
    warehouse.run(400.0);
    EXPECT_EQ(warehouse.drops(), 1U);
    EXPECT_EQ(level > 0.8, almost_empty) << level;
  }
}

// The first AGV charges from 15 % on. Soon afterwards, the second one has this battery level, and gets an order.
struct Shared {
  double left_at = 0.0;  // level at which the first AGV left the charger
  bool charged_first = false;

  explicit Shared(double second) {
    Corridor corridor;
    corridor.drawn.segment(2, corridor.drawn.station(16, 4, FP_PARKING));
    const TestFleet fleet(corridor.drawn.map(), 2);
    FakeWarehouse warehouse(corridor.drawn, fleet, {Corridor::kCharger, 3}, kHullLock, {}, 1);
    warehouse.battery(0, 0.15);
    warehouse.battery(1, 1.0);
    warehouse.order(1, 4.0, 0, 3);
    bool known = false;
    warehouse.after_activation = [&](std::uint32_t) {
      if (warehouse.station_of(0) == Corridor::kCharger) left_at = warehouse.battery_of(0);
      if (!known && left_at > 0.2) warehouse.battery(1, second), known = true;
      if (known && warehouse.drops() == 0 && warehouse.battery_of(1) > second + 0.1) charged_first = true;
    };
    warehouse.run(400.0);
    EXPECT_EQ(warehouse.drops(), 1U);
  }
};

TEST(Charging, AnAgvThatNeedsTheChargerMoreGetsItSoonAndPicksNothingBefore) {
  const Shared shared(0.18);
  EXPECT_TRUE(shared.charged_first);
  EXPECT_GE(shared.left_at, 0.35);
  EXPECT_LT(shared.left_at, 0.6);
}

TEST(Charging, WithSomeBatteryLeftItCarriesLoadsWhileTheChargerIsOccupied) { EXPECT_FALSE(Shared(0.25).charged_first); }

// One charger is near to both AGVs, another one is far. The first AGV drives to the near one, which it does not hold
// yet when the battery of the second one gets low.
TEST(Charging, AnAgvLeavesAChargerToOneThatIsOnItsWayThere) {
  DrawnMap drawn;
  for (int i = 0; i < 12; ++i) drawn.station(8.0 * i, 0);
  for (std::uint32_t i = 0; i < 11; ++i) drawn.segment(i, i + 1);
  const std::uint32_t near = drawn.station(64, 4, FP_CHARGING), far = drawn.station(88, 30, FP_CHARGING);
  drawn.segment(8, near);
  drawn.segment(11, far);
  drawn.map();
  const TestFleet fleet(drawn.map(), 2);
  FakeWarehouse warehouse(drawn, fleet, {0, 10}, kHullLock, {}, 1);
  warehouse.battery(0, 0.2);
  warehouse.battery(1, 1.0);
  bool first_gets_there = false, charged_near = false, charged_far = false;
  warehouse.after_activation = [&](std::uint32_t) {
    if (warehouse.station_of(0) == 2) warehouse.battery(1, 0.2);
    first_gets_there = first_gets_there || warehouse.station_of(0) == near;
    charged_near = charged_near || warehouse.station_of(1) == near;
    charged_far = charged_far || warehouse.station_of(1) == far;
  };
  warehouse.run(100.0);
  EXPECT_TRUE(first_gets_there);
  EXPECT_TRUE(charged_far);
  EXPECT_FALSE(charged_near);
}

}  // namespace
}  // namespace fleetproof::agents::charging_test
