// Shortest ways over the lanes of a map: their order, their first and last lanes, and what cannot be reached.
#include "core/scenario/ways.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace fleetproof::ways_test {
namespace {

// s0 - s1 - s2 in a row of 4 m each, a one-way loop s1 -> s3 -> s2 that is longer, and s4, from which a lane leads to
// s0 but to which none leads.
LogicalMap small_map() {
  Layout layout;
  const Vec2 places[] = {{0.0, 0.0}, {4.0, 0.0}, {8.0, 0.0}, {6.0, 3.0}, {0.0, 9.0}};
  for (const Vec2& place : places) layout.stations.push_back({"s" + std::to_string(layout.stations.size()), place});
  const auto segment = [&](std::uint32_t from, std::uint32_t to, bool both) {
    layout.segments.push_back({"e" + std::to_string(layout.segments.size()), StationId{from}, StationId{to}, both, {}});
  };
  segment(0, 1, true);
  segment(1, 2, true);
  segment(1, 3, false);
  segment(3, 2, false);
  segment(4, 0, false);
  return LogicalMap(layout);
}

const ShortestWay& way_to(const std::vector<ShortestWay>& ways, std::uint32_t station) {
  return *std::ranges::find(ways, StationId{station}, &ShortestWay::to);
}

TEST(ShortestWays, ComeInOrderOfLengthWithTheirLanes) {
  const LogicalMap map = small_map();
  const auto ways = shortest_ways(map, StationId{0U});
  ASSERT_EQ(ways.size(), 4U) << "no lane leads to s4";
  EXPECT_EQ(ways[0].to, StationId{0U});
  EXPECT_EQ(ways[0].first, nullptr);
  EXPECT_EQ(ways[0].last, nullptr);
  EXPECT_TRUE(std::ranges::is_sorted(ways, {}, &ShortestWay::length_m));
  EXPECT_DOUBLE_EQ(way_to(ways, 2).length_m, 8.0) << "not round by s3";
  EXPECT_EQ(way_to(ways, 2).first, map.lane(SegmentId{0U}, StationId{0U}));
  EXPECT_EQ(way_to(ways, 2).last, map.lane(SegmentId{1U}, StationId{1U}));
  EXPECT_EQ(way_to(ways, 3).last, map.lane(SegmentId{2U}, StationId{1U}));
}

TEST(ShortestWays, GoNoFurtherThanAsked) {
  const LogicalMap map = small_map();
  const auto ways = shortest_ways(map, StationId{0U}, StationId{1U});
  ASSERT_EQ(ways.size(), 2U);
  EXPECT_EQ(ways.back().to, StationId{1U});
}

TEST(ShortestWays, KeepOneWayLanesOneWay) {
  const auto ways = shortest_ways(small_map(), StationId{3U});
  EXPECT_DOUBLE_EQ(way_to(ways, 1).length_m, std::sqrt(13.0) + 4.0) << "round by s2";
}

TEST(LengthsTo, AreThoseOfTheShortestWays) {
  const LogicalMap map = small_map();
  for (std::uint32_t goal = 0; goal < map.station_count(); ++goal) {
    const auto lengths_m = lengths_to(map, StationId{goal});
    ASSERT_EQ(lengths_m.size(), map.station_count());
    for (std::uint32_t from = 0; from < map.station_count(); ++from) {
      const ShortestWay way = shortest_ways(map, StationId{from}, StationId{goal}).back();
      if (way.to == StationId{goal}) {
        EXPECT_DOUBLE_EQ(lengths_m[from], way.length_m) << from << " to " << goal;
      } else {
        EXPECT_TRUE(std::isinf(lengths_m[from])) << from << " to " << goal;
      }
    }
  }
}

}  // namespace
}  // namespace fleetproof::ways_test
