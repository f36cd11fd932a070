#include "core/agents/quickest_way.hpp"

#include <gtest/gtest.h>

#include <random>

#include "core/agents/lane_costs.hpp"
#include "core/sdk/fact_store.hpp"
#include "drawn_map.hpp"

namespace fleetproof::agents::quickest_way_test {
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

// Corners that are connected by chains: one-way, both ways, and of both kinds; some end nowhere, some come back to
// their corner, and one ring is connected with nothing.
testing::DrawnMap chains(std::uint32_t columns, std::uint32_t rows, bool tied, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  testing::DrawnMap map;
  const auto shift = [&] { return tied ? 0.0 : 0.3 * static_cast<double>(random() >> 11) * 0x1p-53; };
  const auto x_m = [&](std::uint32_t corner) { return 24.0 * (corner % columns); };
  const auto y_m = [&](std::uint32_t corner) { return 24.0 * (corner / columns); };
  for (std::uint32_t i = 0; i < columns * rows; ++i) map.station(x_m(i) + shift(), y_m(i) + shift());
  const auto connect = [&](std::uint32_t from, std::uint32_t to, double beside_m) {
    const auto kind = random() % 10;
    if (kind == 0) return;
    const std::uint64_t inside = tied || from == to ? 2 : random() % 5;
    if (kind % 2 == 0) std::swap(from, to);
    std::uint32_t last = from;
    const auto go_on = [&](std::uint32_t next) {
      map.segment(last, next, kind < 6 || (kind == 6 && random() % 2 == 0));
      last = next;
    };
    for (std::uint64_t i = 1; i <= inside; ++i) {
      const double part = static_cast<double>(i) / static_cast<double>(inside + 1);
      const double off_m = beside_m + (from == to ? 4.0 * part : 0.0);
      go_on(map.station(x_m(from) + part * (x_m(to) - x_m(from)) + off_m + shift(),
                        y_m(from) + part * (y_m(to) - y_m(from)) + beside_m + shift()));
    }
    if (kind != 7) go_on(to);
  };
  for (std::uint32_t i = 0; i < columns * rows; ++i) {
    if (i % columns + 1 < columns) connect(i, i + 1, 0.0);
    if (i + columns < columns * rows) connect(i, i + columns, 0.0);
    if (i % 7 == 3) connect(i, i, 1.0);
    if (i % 5 == 0 && i % columns + 1 < columns) connect(i, i + 1, 2.0);
  }
  const std::uint32_t ring = map.station(-9.0, 0.0), next = map.station(-9.0, 4.0), end = map.station(-5.0, 4.0);
  map.segment(ring, next, tied), map.segment(next, end, tied), map.segment(end, ring, tied);
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

// Ways of several sections.
TEST(QuickestWay, BeginsSoOnALargeMapToo) {
  std::size_t lanes = 0, no_way = 0;
  for (std::uint64_t seed = 20; seed < 24; ++seed) {
    auto large = grid(40, 30, seed % 2 == 0, seed);
    drive_through(large, seed, 20, lanes, no_way);
  }
  EXPECT_GT(lanes, 1000U);
}

TEST(QuickestWay, BeginsSoInChainsOfStations) {
  std::size_t lanes = 0, no_way = 0;
  for (std::uint64_t seed = 40; seed < 52; ++seed) {
    auto small = chains(4, 4, seed % 2 == 0, seed);
    drive_through(small, seed, 120, lanes, no_way);
  }
  for (std::uint64_t seed = 60; seed < 64; ++seed) {
    auto large = chains(18, 15, seed % 2 == 0, seed);
    drive_through(large, seed, 20, lanes, no_way);
  }
  EXPECT_GT(lanes, 5000U);
  EXPECT_GT(no_way, 20U);
}

}  // namespace
}  // namespace fleetproof::agents::quickest_way_test
