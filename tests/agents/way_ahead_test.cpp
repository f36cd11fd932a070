#include "core/agents/way_ahead.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/agents/drawn_map.hpp"

namespace fleetproof::agents::way_ahead_test {
namespace {

using testing::DrawnMap;

// Ten lanes of 2 m in one line, and one to the side at its end.
struct Line {
  Line() {
    for (int i = 0; i <= 10; ++i) drawn.station(2.0 * i, 0);
    drawn.station(20.0, 8.0);
    for (std::uint32_t i = 0; i <= 10; ++i) drawn.segment(i, i + 1);
    drawn.map();
  }
  DrawnMap drawn;
};

// The test AGV drives 2 m/s, reaches that speed in 4 m, and stops in 2 m.
class WayAheadTest : public ::testing::Test {
 protected:
  Leg drive(std::uint32_t from) const { return {Leg::Kind::Drive, line.drawn.lane_between(from, from + 1)}; }

  Line line;
  MapView map{line.drawn.map()};
  WayAhead way{map, testing::kTestAgv};
};

TEST_F(WayAheadTest, StraightLanesAreOneDrive) {
  for (std::uint32_t i = 0; i < 10; ++i) way.append(drive(i));
  EXPECT_NEAR(way.time_left_s({1.0, 0.0}, 0.0), 3.0 + 20.0 / 2.0, 1e-9) << "a stop at every station would take 34 s";
  EXPECT_NEAR(way.time_left_s({0.0, 1.0}, 0.0), 3.0 + 13.0, 1e-9) << "a turn before it";
  way.append(drive(10));
  EXPECT_NEAR(way.time_left_s({1.0, 0.0}, 0.0), 13.0 + 3.0 + 3.0 + 8.0 / 2.0, 1e-9) << "and a corner";
  way.append({Leg::Kind::Pick});
  EXPECT_NEAR(way.time_left_s({1.0, 0.0}, 0.0), 23.0 + 5.0, 1e-9);
}

TEST_F(WayAheadTest, ADriveUnderWayCountsUpToItsEnd) {
  way.append(drive(1));
  way.begin(drive(0), {1.0, 0.0}, 10.0);
  EXPECT_NEAR(way.current_ends_s(), 10.0 + std::sqrt(12.0), 1e-9) << "if it stops there";
  EXPECT_NEAR(way.time_left_s({1.0, 0.0}, 11.0), std::sqrt(24.0) - 1.0, 1e-9);
  EXPECT_EQ(way.time_left_s({1.0, 0.0}, 100.0), 0.0);
}

// The answer is remembered until a leg is added, ends or goes. `10 s` ago, the AGV was at rest at station 0.
TEST_F(WayAheadTest, EveryChangeOfTheLegsCounts) {
  const Vec along{1.0, 0.0};
  const auto left_s = [&] { return way.time_left_s(along, 10.0) + 10.0; };
  way.begin(drive(0), along, 0.0);
  EXPECT_EQ(left_s(), 10.0) << "overdue";
  for (std::uint32_t i = 1; i < 10; ++i) way.append(drive(i));
  EXPECT_NEAR(left_s(), 13.0, 1e-9) << "20 m from rest to rest";
  way.append({Leg::Kind::Pick});
  EXPECT_NEAR(left_s(), 18.0, 1e-9);
  way.give_next();
  way.end(3.0);
  EXPECT_NEAR(left_s(), 18.0, 1e-9) << "it rolls on";
  way.end(4.0);
  EXPECT_NEAR(left_s(), 10.0 + 3.0 + 16.0 / 2.0 + 5.0, 1e-9) << "it stopped: eight lanes and the load";
  way.begin(way.next(), along, 4.0);
  way.drop_next();
  EXPECT_NEAR(left_s(), 4.0 + 3.0 + 16.0 / 2.0 + 5.0, 1e-9);
  for (int i = 0; i < 7; ++i) way.drop_next();
  EXPECT_NEAR(left_s(), 4.0 + std::sqrt(12.0) + 5.0, 1e-9) << "only the load is left";
  way.end(8.0);
  way.begin(drive(5), along, 9.0);
  EXPECT_NEAR(left_s(), 9.0 + std::sqrt(12.0) + 5.0, 1e-9) << "another drive";
  way.stop();
  EXPECT_NEAR(left_s(), 10.0 + 5.0, 1e-9);
}

TEST_F(WayAheadTest, OnlyADriveStraightOnIsGivenInAdvanceAndOnlyOnce) {
  EXPECT_FALSE(way.can_roll_on()) << "nothing is under way";
  way.begin(drive(0), {1.0, 0.0}, 0.0);
  EXPECT_FALSE(way.can_roll_on()) << "nothing comes next";
  way.append(drive(1));
  EXPECT_TRUE(way.can_roll_on());
  way.give_next();
  EXPECT_FALSE(way.can_roll_on());
  way.end(3.0);
  EXPECT_TRUE(way.acting());
  EXPECT_TRUE(way.empty());
  EXPECT_EQ(way.current().lane, drive(1).lane);
  EXPECT_NEAR(way.current_ends_s(), std::sqrt(24.0), 1e-9) << "both lanes are one drive";
  way.append({Leg::Kind::Drop});
  EXPECT_FALSE(way.can_roll_on()) << "a transfer";
  way.end(5.0);
  EXPECT_FALSE(way.acting());
  way.drop_next();
  way.begin(drive(9), {1.0, 0.0}, 6.0);
  way.append(drive(10));
  EXPECT_FALSE(way.can_roll_on()) << "a corner";
}

}  // namespace
}  // namespace fleetproof::agents::way_ahead_test
