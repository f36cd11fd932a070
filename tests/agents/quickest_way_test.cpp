#include "core/agents/quickest_way.hpp"

#include <gtest/gtest.h>

#include <random>

#include "core/agents/lane_costs.hpp"
#include "core/sdk/fact_store.hpp"
#include "drawn_map.hpp"

namespace fleetproof::agents {
namespace {

// A grid of stations of which some are missing or cannot be left. With equal distances most ways tie; else hardly any.
testing::DrawnMap grid(std::uint32_t columns, std::uint32_t rows, bool tied, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  testing::DrawnMap map;
  const auto shift = [&] { return tied ? 0.0 : 0.3 * static_cast<double>(random() >> 11) * 0x1p-53; };
  for (std::uint32_t i = 0; i < columns * rows; ++i)
    map.station(4.0 * (i % columns) + shift(), 4.0 * (i / columns) + shift());
  const auto connect = [&](std::uint32_t from, std::uint32_t to) {
    const auto kind = random() % 10;
    if (kind == 0) return;
    kind % 2 == 0 ? map.segment(to, from, kind < 7) : map.segment(from, to, kind < 7);
  };
  for (std::uint32_t i = 0; i < columns * rows; ++i) {
    if (i % columns + 1 < columns) connect(i, i + 1);
    if (i + columns < columns * rows) connect(i, i + columns);
  }
  return map;
}

// Drives from one station to another as `next_lane` says; the whole search says the same everywhere.
void drive_through(testing::DrawnMap& drawn, std::uint64_t seed, int drives, std::size_t& lanes, std::size_t& no_way) {
  const FactStore store(drawn.map(), &testing::kTestAgv, 1, sizeof(fp_agv), 0.1);
  const MapView map(store.facts());
  const DriveRules rules(map, 0);
  Routes routes(map, rules);
  QuickestWay way(store.facts(), map, routes, 0);
  const auto times_s = lane_times_s(store.facts(), 0);
  std::mt19937_64 random(seed);
  const auto any = [&] { return static_cast<std::uint32_t>(random() % map.station_count()); };
  std::uint32_t at = any();
  for (int drive = 0; drive < drives; ++drive) {
    std::uint32_t goal = any();
    while (at != goal) {
      routes.search(at, {1.0, 0.0}, times_s, goal);
      const auto expected = routes.lanes(goal);
      const std::uint32_t next = way.next_lane(at, goal);
      ASSERT_EQ(next, expected.empty() ? FP_NONE : expected.front()) << at << " to " << goal;
      no_way += next == FP_NONE ? 1 : 0;
      ++lanes;
      at = next == FP_NONE ? any() : map.lane(next).to;
      if (random() % 20 == 0) goal = any();  // it may change its mind
    }
  }
}

TEST(QuickestWay, BeginsAsTheWayOfAWholeSearch) {
  std::size_t lanes = 0, no_way = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    auto small = grid(9, 8, seed % 2 == 0, seed);
    drive_through(small, seed, 60, lanes, no_way);
  }
  EXPECT_GT(lanes, 2000U);
  EXPECT_GT(no_way, 20U);
}

// Large enough for landmarks.
TEST(QuickestWay, BeginsSoOnALargeMapToo) {
  std::size_t lanes = 0, no_way = 0;
  for (std::uint64_t seed = 20; seed < 24; ++seed) {
    auto large = grid(40, 30, seed % 2 == 0, seed);
    drive_through(large, seed, 20, lanes, no_way);
  }
  EXPECT_GT(lanes, 1000U);
}

}  // namespace
}  // namespace fleetproof::agents
