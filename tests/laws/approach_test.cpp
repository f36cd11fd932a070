#include "laws/approach.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/random.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof::test::approach_test {
namespace {

// Six stations in a row, 4 m apart; the AGV starts at station 1.
class OnItsWay : public testing::Test {
 protected:
  Scenario scenario_ = row_scenario(6, {1, 5}, 600.0);
  Approach approach_{scenario_};
  const EntityId agv_{0U};
};

TEST_F(OnItsWay, DrivingToAndFroGainsNothing) {
  for (int i = 0; i < 2; ++i) approach_.drive_begins(agv_, SegmentId{0U});
  EXPECT_EQ(approach_.gained_m(agv_, StationId{4U}), 0.0);
  EXPECT_EQ(approach_.gained_m(EntityId{1U}, StationId{4U}), 0.0);
}

TEST_F(OnItsWay, TheNearestPlaceSoFarCounts) {
  approach_.drive_begins(agv_, SegmentId{1U});
  approach_.drive_begins(agv_, SegmentId{2U});
  approach_.drive_begins(agv_, SegmentId{2U});
  EXPECT_DOUBLE_EQ(approach_.gained_m(agv_, StationId{4U}), 8.0);
  approach_.begin_anew();
  EXPECT_EQ(approach_.gained_m(agv_, StationId{4U}), 0.0) << "from station 2, where it is now";
}

TEST_F(OnItsWay, WhereTheOperatorSetsItDownItBeginsAnew) {
  approach_.set_down(agv_, StationId{3U});
  EXPECT_EQ(approach_.gained_m(agv_, StationId{4U}), 0.0);
  approach_.drive_begins(agv_, SegmentId{3U});
  EXPECT_DOUBLE_EQ(approach_.gained_m(agv_, StationId{4U}), 4.0);
}

TEST_F(OnItsWay, AHaltOnTheWayTurnsNobodyRound) {
  approach_.drive_begins(agv_, SegmentId{1U});
  approach_.drive_cut_short(agv_);
  approach_.drive_begins(agv_, SegmentId{1U});
  approach_.drive_begins(agv_, SegmentId{2U});
  EXPECT_DOUBLE_EQ(approach_.gained_m(agv_, StationId{4U}), 8.0);
  approach_.drive_begins(agv_, SegmentId{2U});
  approach_.begin_anew();
  approach_.drive_begins(agv_, SegmentId{2U});
  EXPECT_DOUBLE_EQ(approach_.gained_m(agv_, StationId{4U}), 4.0) << "back, and there again: none was cut short";
}

// Asked after each drive, and for one goal or two by turns, it says the same as if it was never asked before.
TEST_F(OnItsWay, WhatItWasAskedBeforeChangesNothing) {
  Draws draws(7);
  std::vector<SegmentId> driven;
  double most_m = 0.0;
  for (int i = 0; i < 400; ++i) {
    if (i % 50 == 0) {
      approach_.begin_anew();
      approach_.set_down(agv_, StationId{1U});
      driven.clear();
    }
    driven.push_back(SegmentId{draws.below(5)});
    approach_.drive_begins(agv_, driven.back());
    const StationId goal{i % 100 < 50 ? 5U : draws.below(6)};
    Approach never_asked(scenario_);
    for (const SegmentId segment : driven) never_asked.drive_begins(agv_, segment);
    const double gained_m = approach_.gained_m(agv_, goal);
    ASSERT_EQ(gained_m, never_asked.gained_m(agv_, goal)) << i;
    most_m = std::max(most_m, gained_m);
  }
  EXPECT_GT(most_m, 7.0);
}

}  // namespace
}  // namespace fleetproof::test::approach_test
