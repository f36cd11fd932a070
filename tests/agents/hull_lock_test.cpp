#include "core/agents/hull_lock.hpp"

#include <gtest/gtest.h>

#include "core/agents/agent_type.hpp"
#include "tests/agents/drawn_map.hpp"
#include "tests/agents/fake_warehouse.hpp"
#include "tests/agents/junction.hpp"
#include "tests/support/reference_agent.hpp"

namespace fleetproof::agents::hull_lock_test {
namespace {

using testing::DrawnMap;
using testing::FakeRadio;
using testing::FakeWarehouse;
using testing::Junction;
using testing::Tally;
using testing::TestFleet;
using testing::watch_holds;

Tally cross_the_junction(const fp_agent_type& type, const FakeRadio& radio, std::uint32_t seeds, double until_s) {
  Junction junction;
  const TestFleet fleet(junction.drawn.map(), 4);
  Tally tally;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    FakeWarehouse warehouse(junction.drawn, fleet,
                            {junction.start(0), junction.start(1), junction.start(2), junction.start(3)}, type, radio,
                            seed);
    for (std::uint32_t i = 0; i < 4; ++i) warehouse.order(i, 0.1, junction.start(i), junction.opposite(i));
    watch_holds(warehouse, fleet, tally);
    warehouse.run(until_s, 4);
    finish(warehouse, tally);
  }
  return tally;
}

class JunctionCells : public ::testing::TestWithParam<FakeRadio> {};

TEST_P(JunctionCells, HullLockNeverHoldsInConflictAndEverybodyGetsAcross) {
  const Tally tally = cross_the_junction(kHullLock, GetParam(), 200, 300.0);
  EXPECT_EQ(tally.conflicting_holds, 0U);
  EXPECT_EQ(tally.claims_too_long, 0U);
  EXPECT_EQ(tally.places_not_held, 0U);
  EXPECT_EQ(tally.violations, 0U);
  EXPECT_EQ(tally.drops, 4 * tally.runs) << "latest " << tally.latest_drop_s << " s";
  EXPECT_GE(tally.locks, 4 * tally.runs);
  EXPECT_GT(tally.overtaken, tally.runs / 4) << "or this tests less than it should";
}

INSTANTIATE_TEST_SUITE_P(LossAndDelay, JunctionCells,
                         ::testing::Values(FakeRadio{0.0, 0.0, false, 0.0}, FakeRadio{0.0, 2.0, true, 0.1},
                                           FakeRadio{0.4, 0.0, false, 0.0}, FakeRadio{0.4, 2.0, true, 0.1},
                                           FakeRadio{0.4, 2.0, false, 0.0}),
                         [](const auto& cell) {
                           return "Loss" + std::to_string(static_cast<int>(cell.param.loss * 100)) + "Delay" +
                                  std::to_string(static_cast<int>(cell.param.delay_s)) +
                                  (cell.param.uniform ? "Uniform" : "Constant");
                         });

TEST(HullLock, StaysSoundBeyondTheContract) {
  const Tally tally = cross_the_junction(kHullLock, {0.6, 3.0, true, 0.2}, 50, 300.0);
  EXPECT_EQ(tally.conflicting_holds, 0U);
  EXPECT_EQ(tally.violations, 0U);
  EXPECT_GT(tally.drops, 0U);
}

TEST(TimeoutGrant, IsAsGoodAsHullLockOnAPerfectRadioOnly) {
  const Tally perfect = cross_the_junction(test::reference_agent("timeout-grant"), {}, 50, 300.0);
  EXPECT_EQ(perfect.conflicting_holds, 0U);
  EXPECT_EQ(perfect.violations, 0U);
  EXPECT_EQ(perfect.drops, 4 * perfect.runs);
  const Tally lossy = cross_the_junction(test::reference_agent("timeout-grant"), {0.4, 2.0, true, 0.0}, 50, 300.0);
  EXPECT_GT(lossy.conflicting_holds, 0U);
  EXPECT_GT(lossy.violations, lossy.runs / 2);
}

TEST(Reckless, RunsIntoOthers) {
  Junction junction;
  const TestFleet fleet(junction.drawn.map(), 4);
  FakeWarehouse warehouse(junction.drawn, fleet,
                          {junction.start(0), junction.start(1), junction.start(2), junction.start(3)}, kReckless, {},
                          1);
  for (std::uint32_t i = 0; i < 4; ++i) warehouse.order(i, 0.1, junction.start(i), junction.opposite(i));
  warehouse.run(120.0);
  EXPECT_EQ(warehouse.drops(), 4U);
  EXPECT_LT(warehouse.least_clearance_m(), 0.10);
}

// Two AGVs in a corridor with one siding, each bound for the place where the other stands.
TEST(HullLock, TwoThatWantEachOthersPlacePassInTheSiding) {
  DrawnMap drawn;
  for (int i = 0; i < 5; ++i) drawn.station(4.0 * i, 0, i % 4 == 0 ? FP_STORAGE : FP_ROUTING);
  const auto siding = drawn.station(8, 3, FP_PARKING);
  for (std::uint32_t i = 0; i < 4; ++i) drawn.segment(i, i + 1);
  drawn.segment(1, siding), drawn.segment(siding, 3);
  const TestFleet fleet(drawn.map(), 2);
  Tally tally;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    FakeWarehouse warehouse(drawn, fleet, {0, 4}, kHullLock, {0.4, 2.0, true, 0.0}, seed);
    warehouse.order(0, 0.1, 0, 4), warehouse.order(1, 0.1, 4, 0);
    watch_holds(warehouse, fleet, tally);
    warehouse.run(400.0, 2);
    finish(warehouse, tally);
  }
  EXPECT_EQ(tally.conflicting_holds, 0U);
  EXPECT_EQ(tally.violations, 0U);
  EXPECT_EQ(tally.drops, 2 * tally.runs) << "latest " << tally.latest_drop_s << " s";
}

// 76 m without a place to wait: more than an AGV may claim at once. It goes there in several claims, and no AGV claims
// too much.
TEST(HullLock, ClaimsNoMoreThanOthersCountOn) {
  DrawnMap drawn;
  for (int i = 0; i < 20; ++i) drawn.station(4.0 * i, 0);
  for (std::uint32_t i = 0; i < 19; ++i) drawn.segment(i, i + 1);
  const auto bay = drawn.station(38, 3.5), other_bay = drawn.station(0, 3.5);
  drawn.segment(9, bay), drawn.segment(0, other_bay);
  const TestFleet fleet(drawn.map(), 2);
  Tally tally;
  FakeWarehouse warehouse(drawn, fleet, {0, bay}, kHullLock, {0.4, 2.0, true, 0.0}, 1);
  warehouse.order(0, 0.1, 0, 19), warehouse.order(0, 0.2, 19, 0);
  watch_holds(warehouse, fleet, tally);
  warehouse.run(400.0, 2);
  EXPECT_EQ(warehouse.drops(), 2U);
  EXPECT_EQ(tally.claims_too_long, 0U);
  EXPECT_EQ(tally.places_not_held, 0U);
  EXPECT_EQ(tally.conflicting_holds, 0U);
}

TEST(HullLock, IdleAgvMakesWay) {
  DrawnMap drawn;
  for (int i = 0; i < 4; ++i) drawn.station(4.0 * i, 0);
  const auto bay = drawn.station(8, 3.5, FP_PARKING);
  for (std::uint32_t i = 0; i < 3; ++i) drawn.segment(i, i + 1);
  drawn.segment(2, bay);
  const TestFleet fleet(drawn.map(), 2);
  FakeWarehouse warehouse(drawn, fleet, {0, 3}, kHullLock, {}, 1);
  warehouse.order(0, 0.1, 0, 3);
  warehouse.run(100.0);
  EXPECT_EQ(warehouse.drops(), 1U);
  EXPECT_TRUE(warehouse.probes().contains("makes-way"));
}

// It stands somewhere on a lane, for good; others must keep clear of all it held, and not of more.
TEST(HullLock, KeepsHoldingWhenItBreaksDown) {
  Junction junction;
  const TestFleet fleet(junction.drawn.map(), 4);
  Tally tally;
  FakeWarehouse warehouse(junction.drawn, fleet,
                          {junction.start(0), junction.start(1), junction.start(2), junction.start(3)}, kHullLock, {},
                          1);
  watch_holds(warehouse, fleet, tally);
  for (std::uint32_t i = 0; i < 4; ++i) warehouse.order(i, 0.1, junction.start(i), junction.opposite(i));
  auto watched = warehouse.after_activation;
  warehouse.after_activation = [&](std::uint32_t id) {
    watched(id);
    if (id == 0 && static_cast<const HullLock*>(warehouse.agent(0))->protocol().held().count == 2)
      warehouse.stop_motion_of(0);
  };
  warehouse.run(300.0);
  EXPECT_EQ(tally.conflicting_holds, 0U);
  EXPECT_GE(static_cast<const HullLock*>(warehouse.agent(0))->protocol().held().count, 1U);
}

// The next move is given while the lane before it is driven, on floor that is held.
TEST(HullLock, DrivesStraightOnWithoutAStop) {
  DrawnMap drawn;
  for (int i = 0; i < 5; ++i) drawn.station(8.0 * i, 0, i % 4 == 0 ? FP_STORAGE : FP_ROUTING);
  for (std::uint32_t i = 0; i < 4; ++i) drawn.segment(i, i + 1);
  const TestFleet fleet(drawn.map(), 1);
  FakeWarehouse warehouse(drawn, fleet, {0}, kHullLock, {}, 1);
  warehouse.order(0, 0.1, 0, 4);
  std::uint32_t given = 0;
  const fp_lane* last = nullptr;
  warehouse.after_activation = [&](std::uint32_t) {
    const fp_lane* next = warehouse.next_of(0);
    given += next != nullptr && next != last;
    const Path& held = static_cast<const HullLock*>(warehouse.agent(0))->protocol().held();
    EXPECT_TRUE(next == nullptr || held.count > 1U);
    last = next;
  };
  warehouse.run(100.0, 1);
  EXPECT_EQ(warehouse.drops(), 1U);
  EXPECT_EQ(given, 3U) << "all lanes but the first";
}

TEST(HullLock, AFleetOutOfRadioReachStandsStill) {
  const Tally tally = cross_the_junction(kHullLock, {1.0, 0.0, false, 0.0}, 3, 120.0);
  EXPECT_EQ(tally.locks, 0U);
  EXPECT_EQ(tally.drops, 0U);
}

// The bodies are clear of each other, the bodies with loads are not.
TEST(HullLock, WhereItStartsItTakesALoadOnlyIfThereIsRoomForIt) {
  fp_agv wide = testing::kTestAgv;
  wide.loaded_width_m = 1.4;
  for (const double apart_m : {1.2, 6.0}) {
    DrawnMap drawn;
    for (const double y_m : {0.0, apart_m}) drawn.station(0, y_m), drawn.station(6, y_m);
    drawn.segment(0, 1), drawn.segment(2, 3);
    const TestFleet fleet(drawn.map(), 2, wide);
    FakeWarehouse warehouse(drawn, fleet, {0, 2}, kHullLock, {}, 1);
    warehouse.order(0, 0.1, 0, 1);
    warehouse.run(100.0);
    EXPECT_EQ(warehouse.calls().empty(), apart_m < 2.0);
    EXPECT_EQ(warehouse.drops(), apart_m < 2.0 ? 0U : 1U);
  }
}

}  // namespace
}  // namespace fleetproof::agents::hull_lock_test
