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

  void drive(std::uint32_t segment, double takes_s = 0.0) {
    approach_.drive_begins(agv_, SegmentId{segment});
    approach_.spend(agv_, seconds(takes_s));
    approach_.drive_ends(agv_, true);
  }
  Approach::Gain gain(std::uint32_t goal) { return approach_.gain(agv_, StationId{goal}); }
};

TEST_F(OnItsWay, DrivingToAndFroGainsNothing) {
  for (int i = 0; i < 2; ++i) drive(0);
  EXPECT_EQ(approach_.gain(agv_, StationId{4U}).way_m, 0.0);
  EXPECT_EQ(approach_.gain(EntityId{1U}, StationId{4U}).way_m, 0.0);
}

TEST_F(OnItsWay, TheNearestPlaceSoFarCounts) {
  drive(1);
  drive(2);
  drive(2);
  EXPECT_DOUBLE_EQ(approach_.gain(agv_, StationId{4U}).way_m, 8.0);
  approach_.begin_anew();
  EXPECT_EQ(approach_.gain(agv_, StationId{4U}).way_m, 0.0) << "from station 2, where it is now";
}

TEST_F(OnItsWay, WhereTheOperatorSetsItDownItBeginsAnew) {
  approach_.set_down(agv_, StationId{3U});
  EXPECT_EQ(approach_.gain(agv_, StationId{4U}).way_m, 0.0);
  drive(3);
  EXPECT_DOUBLE_EQ(approach_.gain(agv_, StationId{4U}).way_m, 4.0);
}

TEST_F(OnItsWay, AHaltOnTheWayTurnsNobodyRound) {
  approach_.drive_begins(agv_, SegmentId{1U});
  approach_.drive_ends(agv_, false);
  drive(1);
  drive(2);
  EXPECT_DOUBLE_EQ(approach_.gain(agv_, StationId{4U}).way_m, 8.0);
  drive(2);
  approach_.begin_anew();
  drive(2);
  EXPECT_DOUBLE_EQ(approach_.gain(agv_, StationId{4U}).way_m, 4.0) << "back, and there again: none was cut short";
}

TEST_F(OnItsWay, OnlyDrivesThatBringItNearerTakeTime) {
  drive(1, 10.0);
  drive(1, 20.0);
  drive(1, 30.0);
  EXPECT_EQ(gain(4).took, seconds(10.0));
  EXPECT_FALSE(gain(4).by_last_drive);
  drive(2, 40.0);
  EXPECT_EQ(gain(4).took, seconds(50.0));
  EXPECT_TRUE(gain(4).by_last_drive);
  approach_.spend(agv_, seconds(1.0));  // it settles
  EXPECT_EQ(gain(4).took, seconds(51.0));
  EXPECT_EQ(gain(0).took, Duration{}) << "for the other goal, no drive did";
}

TEST_F(OnItsWay, ADriveUnderWayCountsAnew) {
  approach_.drive_begins(agv_, SegmentId{1U});
  approach_.begin_anew();
  EXPECT_DOUBLE_EQ(gain(4).way_m, 4.0);
  EXPECT_TRUE(gain(4).by_last_drive);
  approach_.drive_ends(agv_, true);
  approach_.begin_anew();
  EXPECT_EQ(gain(4).way_m, 0.0) << "it has arrived";
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
    approach_.drive_ends(agv_, true);
    const StationId goal{i % 100 < 50 ? 5U : draws.below(6)};
    Approach never_asked(scenario_);
    for (const SegmentId segment : driven) never_asked.drive_begins(agv_, segment);
    const double gained_m = approach_.gain(agv_, goal).way_m;
    ASSERT_EQ(gained_m, never_asked.gain(agv_, goal).way_m) << i;
    most_m = std::max(most_m, gained_m);
  }
  EXPECT_GT(most_m, 7.0);
}

}  // namespace
}  // namespace fleetproof::test::approach_test
