// The planner of the zone-server: which AGV carries out an open order, who makes way, and when an AGV charges.
#include "core/agents/central/fleet_planner.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/agents/central/floor_book.hpp"
#include "core/agents/facts.hpp"
#include "core/agents/hull.hpp"
#include "core/agents/map_view.hpp"
#include "core/agents/settings.hpp"
#include "tests/agents/drawn_map.hpp"

namespace fleetproof::agents::central::fleet_planner_test {
namespace {

using testing::DrawnMap;
using testing::TestFleet;

class PlannerOfTwoAgvs : public ::testing::Test {
 protected:
  PlannerOfTwoAgvs(DrawnMap of, std::uint32_t place_0, std::uint32_t place_1) : drawn(std::move(of)) {
    join(0, place_0, 0);
    join(1, place_1, 0);
  }

  void join(std::uint32_t agv, std::uint32_t station, std::uint32_t boot, std::uint32_t load = FP_NONE) {
    State state;
    state.way.agv_boot = boot;
    state.stands = true;
    state.station = station;
    state.load = load;
    ASSERT_EQ(book.hear(agv, state), FloorBook::News::Joined);
    planner.begin(agv);
  }
  // The AGV has carried out all that was granted.
  void arrive(std::uint32_t agv, double battery = 1.0) {
    State state;
    state.battery = battery;
    state.way = book.number_of(agv);
    state.stands = true;
    state.known = state.done = book.way(agv).granted();
    state.number = ++messages;
    book.hear(agv, state);
  }
  void plan() { planner.plan(now_ns += kSecond); }
  bool has_step(std::uint32_t agv, Step::Kind kind, std::uint32_t order) const {
    return std::ranges::count(book.way(agv).steps, Step{kind, order}) == 1;
  }

  // After some sections, each of which it drives.
  bool gets_to_pick(std::uint32_t agv, std::uint32_t order) {
    for (int i = 0; i < 5; ++i) {
      plan();
      if (has_step(agv, Step::Kind::Pick, order)) return true;
      arrive(agv);
    }
    return false;
  }

  static constexpr std::int64_t kSecond = 1'000'000'000;
  DrawnMap drawn;
  TestFleet fleet{drawn.map(), 2};
  fp_briefing briefing = fleet.briefing(0, 0);
  Facts facts{briefing};
  MapView map{facts.shared()};
  HullGeometry geometry{map, briefing};
  Settings settings;
  FloorBook book{map, geometry, 2, 0};
  FleetPlanner planner{map, geometry, book, settings};
  std::int64_t now_ns = 0;
  std::uint32_t messages = 0;
};

// A ring of eight stations, 10 m apart, with two-way lanes. AGV 0 stands at station 0, AGV 1 at station 4.
class PlannerOnARing : public PlannerOfTwoAgvs {
 protected:
  PlannerOnARing() : PlannerOfTwoAgvs(ring(), 0, 4) {}
  static DrawnMap ring() {
    DrawnMap drawn;
    const double at[8][2] = {{0, 0}, {10, 0}, {20, 0}, {20, 10}, {20, 20}, {10, 20}, {0, 20}, {0, 10}};
    for (const auto& [x_m, y_m] : at) drawn.station(x_m, y_m, FP_STORAGE);
    for (std::uint32_t i = 0; i < 8; ++i) drawn.segment(i, (i + 1) % 8);
    return drawn;
  }
};

TEST_F(PlannerOnARing, AnOpenOrderGoesToTheAgvThatIsThereFirst) {
  planner.take_open_order({7, 3, 2});
  plan();
  EXPECT_TRUE(has_step(1, Step::Kind::Pick, 7));
  planner.take_open_order({8, 2, 1});
  EXPECT_TRUE(gets_to_pick(0, 8)) << "the other one ends there, but has to work before";
}

TEST_F(PlannerOnARing, ADeliveredOrderIsOver) {
  planner.take_open_order({7, 3, 2});
  for (int i = 0; i < 5; ++i) plan(), arrive(0), arrive(1);
  const std::uint32_t done = book.way(1).done;
  EXPECT_GE(done, 4U);
  join(1, 2, 1);
  for (int i = 0; i < 5; ++i) plan(), arrive(0), arrive(1);
  EXPECT_FALSE(has_step(0, Step::Kind::Pick, 7) || has_step(1, Step::Kind::Pick, 7));
  EXPECT_EQ(book.way(1).done, 0U) << "nothing is left to do after a restart";
}

TEST_F(PlannerOnARing, ARestartedAgvKeepsOnlyTheOrderOnBoard) {
  planner.take_open_order({7, 3, 2});
  plan();
  join(1, 7, 1);
  EXPECT_TRUE(gets_to_pick(0, 7)) << "the other one had not picked it, and came to stand farther away";
  EXPECT_FALSE(has_step(1, Step::Kind::Pick, 7));
  join(0, 3, 1, 7);
  plan();
  EXPECT_FALSE(has_step(0, Step::Kind::Pick, 7));
  EXPECT_TRUE(has_step(0, Step::Kind::Drop, 7));
}

TEST_F(PlannerOnARing, AnOrderIsWithdrawnUntilItsPickIsGranted) {
  planner.take_open_order({7, 3, 2});
  planner.withdraw(7);
  plan();
  EXPECT_TRUE(book.way(1).steps.empty());
  planner.take_open_order({8, 3, 2});
  plan();
  planner.withdraw(8);
  arrive(1);
  plan();
  EXPECT_TRUE(has_step(1, Step::Kind::Drop, 8)) << "it may have had the load already";
}

TEST_F(PlannerOnARing, AnAgvWithoutWorkMakesWay) {
  planner.take_orders(1, 0, std::vector<Order>{{7, 0, 1}});
  for (int i = 0; i < 20; ++i) plan(), arrive(0), arrive(1);
  EXPECT_NE(book.way(0).held.station, 0U) << "the other one had to pick there";
  EXPECT_GE(book.way(1).done, 5U);
}

// Stations 0 to 3 in a row, 10 m apart, and station 4 beside station 1, which is the only charger. A loaded AGV cannot
// leave station 0. AGV 0 stands at the charger, AGV 1 at station 3.
class PlannerOnARow : public PlannerOfTwoAgvs {
 protected:
  PlannerOnARow() : PlannerOfTwoAgvs(row(), 1, 3) {}
  static DrawnMap row() {
    DrawnMap drawn;
    for (std::uint32_t i = 0; i < 4; ++i) drawn.station(10.0 * i, 0, i == 1 ? FP_CHARGING : FP_STORAGE);
    for (std::uint32_t i = 0; i < 3; ++i) drawn.segment(i, i + 1);
    drawn.segment(1, drawn.station(10, 10));
    drawn.permit(0, 1, FP_EMPTY_ONLY);
    return drawn;
  }
  // AGV 0 charges, and AGV 1 drives.
  void live(double seconds, double battery_1 = 1.0) {
    for (; seconds > 0.0; seconds -= 1.0) arrive(0, 0.15), arrive(1, battery_1), plan();
  }
};

TEST_F(PlannerOnARow, AnAgvThatChargesMakesWayForOneThatHasWaitedLong) {
  planner.take_orders(1, 0, std::vector<Order>{{7, 0, 3}});
  live(30);
  EXPECT_EQ(book.end_of_way(0).station, 1U);
  EXPECT_FALSE(has_step(1, Step::Kind::Pick, 7));
  live(30);
  EXPECT_TRUE(book.way(1).done > 2 || has_step(1, Step::Kind::Pick, 7)) << "it got past";
}

TEST_F(PlannerOnARow, AnAgvWithALowBatteryWorksOnIfNoChargerIsFree) {
  live(3, 0.25);
  planner.take_open_order({7, 2, 3});
  live(1, 0.25);
  EXPECT_TRUE(has_step(1, Step::Kind::Pick, 7));
}

TEST_F(PlannerOnARow, AnAgvDropsItsLoadWhereItCannotLeaveWithIt) {
  join(0, 1, 1, 7);
  planner.take_orders(0, 0, std::vector<Order>{{7, 3, 0}});
  plan();
  EXPECT_TRUE(has_step(0, Step::Kind::Drop, 7));
}

}  // namespace
}  // namespace fleetproof::agents::central::fleet_planner_test
