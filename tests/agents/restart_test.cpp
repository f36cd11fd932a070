// hull-lock when its computer restarts, again and again, at any moment: no two AGVs ever hold conflicting hulls, and
// all loads arrive where they should.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <tuple>

#include "core/agents/agent_type.hpp"
#include "tests/agents/junction.hpp"
#include "tests/support/reference_agent.hpp"

namespace fleetproof::agents::restart_test {
namespace {

using testing::DrawnMap;
using testing::FakeRadio;
using testing::FakeWarehouse;
using testing::Junction;
using testing::Tally;
using testing::TestFleet;
using testing::watch_holds;

// Every AGV restarts four times within the first 100 s.
Tally cross_with_restarts(const FakeRadio& radio, std::uint32_t seeds) {
  Junction junction;
  const TestFleet fleet(junction.drawn.map(), 4);
  Tally tally;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    FakeWarehouse warehouse(junction.drawn, fleet,
                            {junction.start(0), junction.start(1), junction.start(2), junction.start(3)}, kHullLock,
                            radio, seed);
    std::mt19937_64 draws(seed);
    std::uniform_real_distribution<double> share;
    for (std::uint32_t i = 0; i < 4; ++i) {
      warehouse.order(i, 0.1, junction.start(i), junction.opposite(i));
      warehouse.order(i, 30.0, junction.opposite(i), junction.start(i));
      for (int k = 0; k < 4; ++k) warehouse.restart(i, 25.0 * k + 1.0 + 18.0 * share(draws), 0.1 + 5.0 * share(draws));
    }
    watch_holds(warehouse, fleet, tally);
    warehouse.run(600.0, 8);
    finish(warehouse, tally);
  }
  return tally;
}

class RestartCells : public ::testing::TestWithParam<FakeRadio> {};

TEST_P(RestartCells, NobodyHoldsInConflictAndEveryLoadArrives) {
  const Tally tally = cross_with_restarts(GetParam(), 100);
  EXPECT_EQ(tally.conflicting_holds, 0U);
  EXPECT_EQ(tally.claims_too_long, 0U);
  EXPECT_EQ(tally.places_not_held, 0U);
  EXPECT_EQ(tally.violations, 0U);
  EXPECT_EQ(tally.misplaced, 0U);
  EXPECT_EQ(tally.drops, 8 * tally.runs) << "latest " << tally.latest_drop_s << " s";
  EXPECT_GT(tally.restarts, 10 * tally.runs) << "or this tests less than it should";
  EXPECT_GT(tally.restarts_on_lanes, tally.runs);
}

INSTANTIATE_TEST_SUITE_P(LossAndDelay, RestartCells,
                         ::testing::Values(FakeRadio{0.0, 0.0, false, 0.0}, FakeRadio{0.0, 2.0, true, 0.2},
                                           FakeRadio{0.4, 2.0, true, 0.2}),
                         [](const auto& cell) {
                           return "Loss" + std::to_string(static_cast<int>(cell.param.loss * 100)) + "Delay" +
                                  std::to_string(static_cast<int>(cell.param.delay_s));
                         });

struct Corridor {
  Corridor() {
    for (int i = 0; i < 4; ++i) drawn.station(8.0 * i, 0);
    for (std::uint32_t i = 0; i < 3; ++i) drawn.segment(i, i + 1);
    drawn.map();
  }
  DrawnMap drawn;
};

const Path& held_by(FakeWarehouse& warehouse, std::uint32_t id) {
  return static_cast<const HullLock*>(warehouse.agent(id))->protocol().held();
}

// Lanes of 8 m, each 7 s. The former self has given the move over the second lane when it was on the first one.
TEST(Restart, HoldsTheLanesThatTheAgvWillDriveFromItsFirstInstantAndNothingBeyond) {
  Corridor corridor;
  const TestFleet fleet(corridor.drawn.map(), 1);
  for (const auto& [at_s, first, lanes] : {std::tuple(7.0, 0U, 2U), {21.0, 2U, 1U}}) {
    FakeWarehouse warehouse(corridor.drawn, fleet, {0}, kHullLock, {}, 1);
    warehouse.order(0, 0.1, 0, 3);  // 5 s of picking
    warehouse.restart(0, at_s, 2.0);
    std::vector<std::uint32_t> counts;
    warehouse.after_activation = [&](std::uint32_t) {
      if (warehouse.boot_of(0) == 1 && counts.empty()) {
        EXPECT_EQ(held_by(warehouse, 0).station, first);
        EXPECT_EQ(held_by(warehouse, 0).lane_ids[0], corridor.drawn.lane_between(first, first + 1));
        const std::uint32_t next = corridor.drawn.lane_between(first + 1, first + 2);
        EXPECT_TRUE(lanes < 2 || held_by(warehouse, 0).lane_ids[1] == next);
      }
      if (warehouse.boot_of(0) == 1) counts.push_back(held_by(warehouse, 0).count);
    };
    warehouse.run(100.0);
    ASSERT_FALSE(counts.empty());
    EXPECT_EQ(counts.front(), lanes);
    EXPECT_EQ(warehouse.drops(), 1U);
    EXPECT_EQ(warehouse.misplaced(), 0U);
  }
}

// An AGV makes half a turn beside the lane of another one, which waits for that. In the middle of the turn its computer
// restarts, and does not know where the turn began.
TEST(Restart, HoldsTheTurnThatTheAgvMayBeMaking) {
  DrawnMap drawn;
  const auto from = drawn.station(0, 0, FP_STORAGE), to = drawn.station(14, 0, FP_STORAGE);
  const auto beside = drawn.station(-1.7, 1.2, FP_STORAGE), away = drawn.station(20, 1.2, FP_STORAGE);
  drawn.segment(from, to), drawn.segment(beside, away);
  const TestFleet fleet(drawn.map(), 2);
  const auto least_m = [&](const fp_agent_type& type, double restart_s) {
    FakeWarehouse warehouse(drawn, fleet, {from, beside}, type, FakeRadio{0.0, 0.01, false, 0.0}, 1);
    warehouse.heading(0, -1, 0);
    warehouse.order(0, 0.1, from, to);  // 5 s of picking, 4 s of turning
    warehouse.order(1, 1.0, away, beside);
    warehouse.restart(0, restart_s, 0.1);
    warehouse.run(120.0);
    EXPECT_EQ(warehouse.drops(), 2U);
    return warehouse.least_clearance_m();
  };
  double least_of_faulty_m = INFINITY;
  for (double restart_s = 5.5; restart_s < 9.0; restart_s += 0.5) {
    EXPECT_GE(least_m(kHullLock, restart_s), 0.1) << restart_s;
    least_of_faulty_m = std::min(least_of_faulty_m, least_m(test::reference_agent("restart-forgets-turn"), restart_s));
  }
  EXPECT_LT(least_of_faulty_m, 0.1) << "or this tests nothing";
}

// An AGV turns on the spot, from the heading of the lane to the east to a lane that leads `turn_rad` to the left.
// Another AGV passes it in the direction `side_rad` and at the distance `beside_m`, both from the station of the turn.
// The first one's computer restarts in the middle of the turn. Both orders must be done.
struct BesideATurn {
  double turn_rad, side_rad, beside_m, order_s;

  struct Seen {
    double least_clearance_m = 0.0;
    bool both_held = false;  // after the restart, the first one its turn and the other one its lane
  };
  Seen run(const fp_agent_type& type, double restart_s) const;
};

BesideATurn::Seen BesideATurn::run(const fp_agent_type& type, double restart_s) const {
  DrawnMap drawn;
  const auto at = [&](double along_m, double across_m, double angle_rad) {
    return drawn.station(along_m * std::cos(angle_rad) - across_m * std::sin(angle_rad),
                         along_m * std::sin(angle_rad) + across_m * std::cos(angle_rad), FP_STORAGE);
  };
  const auto from = at(0, 0, 0), to = at(14, 0, turn_rad), west = at(-14, 0, 0);
  const auto beside = at(beside_m, 2.0, side_rad), away = at(beside_m, -12.0, side_rad);
  drawn.segment(west, from), drawn.segment(from, to), drawn.segment(beside, away);
  const TestFleet fleet(drawn.map(), 2);
  FakeWarehouse warehouse(drawn, fleet, {from, beside}, type, FakeRadio{0.0, 0.01, false, 0.0}, 1);
  warehouse.heading(1, std::sin(side_rad), -std::cos(side_rad));
  warehouse.order(0, 0.1, from, to);  // 5 s of picking
  warehouse.order(1, order_s, away, beside);
  warehouse.restart(0, restart_s, 0.1);
  bool both_held = false;
  warehouse.after_activation = [&](std::uint32_t id) {
    if (id != 0 || warehouse.boot_of(0) != 1) return;
    both_held |= held_by(warehouse, 0).station == from && !held_by(warehouse, 0).empty() &&
                 held_by(warehouse, 1).station == beside && !held_by(warehouse, 1).empty();
  };
  warehouse.run(120.0);
  EXPECT_EQ(warehouse.drops(), 2U) << restart_s;
  return {warehouse.least_clearance_m(), both_held};
}

// Before and after the turn, the AGV is out of the other one's way; in between, its corner is in it.
TEST(Restart, HoldsTheSectorOfTheTurnThatTheAgvIsMaking) {
  const BesideATurn scene{130.0 / 180.0 * M_PI, 245.0 / 180.0 * M_PI, 1.42, 1.0};
  double least_of_faulty_m = INFINITY;
  for (double restart_s = 5.1; restart_s < 8.0; restart_s += 0.25) {
    EXPECT_GE(scene.run(kHullLock, restart_s).least_clearance_m, 0.1) << restart_s;
    least_of_faulty_m = std::min(least_of_faulty_m,
                                 scene.run(test::reference_agent("restart-forgets-turn"), restart_s).least_clearance_m);
  }
  EXPECT_LT(least_of_faulty_m, 0.1) << "or this tests nothing";
}

// A small turn leaves much of the disc free, and another AGV drives there meanwhile. The new self does not know where
// its turn began, and both must go on.
TEST(Restart, InATurnBesideAnAgvInTheDiscLetsBothGoOn) {
  const BesideATurn scene{30.0 / 180.0 * M_PI, 285.0 / 180.0 * M_PI, 1.42, 4.0};
  for (double restart_s = 5.2; restart_s < 6.5; restart_s += 0.2) {
    const auto seen = scene.run(kHullLock, restart_s);
    EXPECT_TRUE(seen.both_held) << restart_s;
    EXPECT_GE(seen.least_clearance_m, 0.1) << restart_s;
  }
}

// A long AGV stands across, beside the lane of another one. Its computer restarts, and sees the heading of before.
TEST(Restart, NobodyTakesAnAgvForOutOfTheWayThatDoesNotKnowItsHeading) {
  for (const char* config : {"", "zones_from=2"}) {
    DrawnMap drawn;
    const auto from = drawn.station(0, 1.35, FP_STORAGE), to = drawn.station(14, 1.35, FP_STORAGE);
    const auto beside = drawn.station(7, 0, FP_STORAGE), away = drawn.station(7, -9, FP_STORAGE);
    drawn.segment(from, to), drawn.segment(beside, away);
    TestFleet fleet(drawn.map(), 2);
    fleet.config = config;
    FakeWarehouse warehouse(drawn, fleet, {from, beside}, kHullLock, FakeRadio{0.0, 0.01, false, 0.0}, 1);
    warehouse.heading(0, 1, 0), warehouse.heading(1, 0, 1);
    warehouse.late_heading(1, {1'300'000'000, 1, 0});
    warehouse.restart(1, 0.3, 0.1);
    warehouse.order(0, 0.6, from, to);
    warehouse.run(60.0);
    EXPECT_GE(warehouse.least_clearance_m(), 0.1) << config;
    EXPECT_EQ(warehouse.boot_of(1), 1U);
  }
}

TEST(Restart, DuringATransferItWaitsForItsEndAndNeitherPicksNorDropsTwice) {
  Corridor corridor;
  const TestFleet fleet(corridor.drawn.map(), 1);
  for (const double at_s : {0.5, 3.0, 5.05, 5.5, 27.0, 29.0, 31.0, 33.0}) {
    FakeWarehouse warehouse(corridor.drawn, fleet, {0}, kHullLock, {}, 1);
    warehouse.order(0, 0.1, 0, 3);
    warehouse.order(0, 0.2, 3, 1);
    warehouse.restart(0, at_s, 1.0);
    warehouse.run(200.0);
    EXPECT_EQ(warehouse.drops(), 2U) << at_s;
    EXPECT_EQ(warehouse.misplaced(), 0U) << at_s;
  }
}

// Its end would otherwise be taken for the end of what the new self began.
TEST(Restart, NothingIsBegunBeforeTheActionOfTheFormerSelfIsOver) {
  Corridor corridor;
  const TestFleet fleet(corridor.drawn.map(), 1);
  FakeWarehouse warehouse(corridor.drawn, fleet, {0}, kHullLock, {}, 1);
  warehouse.order(0, 0.1, 0, 3);  // picks until 5.1 s
  warehouse.restart(0, 0.5, 0.1);
  warehouse.run(60.0);
  for (const auto& [at_s, call] : warehouse.calls()) EXPECT_TRUE(at_s < 0.5 || at_s > 5.0) << at_s;
  EXPECT_EQ(warehouse.drops(), 1U);
}

TEST(Restart, ALoadOnBoardIsNotFetchedAgain) {
  Corridor corridor;
  const TestFleet fleet(corridor.drawn.map(), 1);
  FakeWarehouse warehouse(corridor.drawn, fleet, {0}, kHullLock, {}, 1);
  warehouse.order(0, 0.1, 0, 3);
  warehouse.restart(0, 7.0, 1.0);
  warehouse.run(100.0);
  EXPECT_EQ(std::ranges::count(warehouse.calls(), static_cast<std::uint32_t>(FP_CALL_PICK),
                               [](const auto& call) { return call.second; }),
            1);
  EXPECT_EQ(warehouse.drops(), 1U);
}

}  // namespace
}  // namespace fleetproof::agents::restart_test
