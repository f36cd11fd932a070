#include "core/agents/opposite_lanes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/agents/hull.hpp"
#include "tests/agents/drawn_map.hpp"

namespace fleetproof::agents::opposite_lanes_test {
namespace {

using testing::DrawnMap;
using testing::TestFleet;

// A main aisle of two one-way lanes, eastwards in the south and westwards in the north. A street to the south leads
// back west, one to the north leads back east, and a link in the east joins them.
//   8 ----------> 9
//   4 <- 5 <- 6 <- 7
//   0 -> 1 -> 2 -> 3    12
//   10 <--------- 11
struct MainAisle {
  MainAisle(double gap_m, const std::vector<std::uint32_t>& goals) {
    const auto station = [&](double x_m, double y_m) {
      const bool is_goal = std::ranges::find(goals, stations) != goals.end();
      ++stations;
      drawn.station(x_m, y_m, is_goal ? FP_STORAGE : FP_ROUTING);
    };
    for (const double y_m : {0.0, 1.0 + gap_m}) {
      for (std::uint32_t i = 0; i < 4; ++i) station(8.0 * i, y_m);
    }
    station(0, 9), station(24, 9), station(0, -8), station(24, -8), station(32, 0);
    for (const auto& round : {std::vector<std::uint32_t>{0, 1, 2, 3, 11, 10, 0}, {7, 6, 5, 4, 8, 9, 7}}) {
      for (std::size_t i = 0; i + 1 < round.size(); ++i) drawn.segment(round[i], round[i + 1], false);
    }
    drawn.segment(11, 12), drawn.segment(12, 9);
  }

  // The lanes of the main aisle that are against the convention, by the stations where they begin.
  std::vector<std::uint32_t> against() {
    const TestFleet fleet(drawn.map(), 3);
    const MapView map(drawn.map());
    const HullGeometry geometry(map, fleet.briefing(0, 0));
    const OppositeLanes lanes(map, geometry.parts());
    std::vector<std::uint32_t> found;
    for (std::uint32_t lane = 0; lane < map.lane_count(); ++lane) {
      if (lanes.is_against(lane)) found.push_back(map.lane(lane).from);
    }
    return found;
  }

  DrawnMap drawn;
  std::uint32_t stations = 0;
};

TEST(OppositeLanes, TooNearGetOneDirectionThatSuitsTheGoals) {
  EXPECT_EQ(MainAisle(0.05, {1, 2, 10, 11}).against(), (std::vector<std::uint32_t>{7, 6, 5}));
  EXPECT_EQ(MainAisle(0.05, {5, 6, 8, 9}).against(), (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST(OppositeLanes, ThatLeaveRoomForTwoKeepBothDirections) {
  EXPECT_TRUE(MainAisle(0.3, {1, 2, 10, 11}).against().empty());
}

}  // namespace
}  // namespace fleetproof::agents::opposite_lanes_test
