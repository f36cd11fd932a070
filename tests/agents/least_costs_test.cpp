#include "core/agents/least_costs.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "tests/agents/drawn_map.hpp"

namespace fleetproof::agents::least_costs_test {
namespace {

using testing::DrawnMap;

// Streets that cross, with chains of stations, bays and one-way rings.
void draw(DrawnMap& drawn, std::mt19937& bits) {
  constexpr std::uint32_t kCrossings = 12;
  const auto random = [&] { return static_cast<std::uint32_t>(bits()); };
  for (std::uint32_t i = 0; i < kCrossings; ++i) drawn.station(50.0 * (i % 4), 50.0 * (i / 4));
  const auto some = [&] { return 1.0 + random() % 40; };
  for (std::uint32_t i = 0; i < 30; ++i) {
    const bool both_ways = random() % 3 != 0;
    std::uint32_t at = random() % kCrossings;
    for (std::uint32_t length = random() % 6; length > 0; --length) {
      const std::uint32_t next = drawn.station(some(), some());
      drawn.segment(at, next, both_ways);
      if (random() % 3 == 0) drawn.segment(next, drawn.station(some(), some()), random() % 4 != 0);
      at = next;
    }
    const std::uint32_t end = random() % 9 == 0 ? at : random() % kCrossings;
    if (end != at) drawn.segment(at, end, both_ways);
  }
  const auto first = drawn.station(1, 300), second = drawn.station(9, 300), third = drawn.station(1, 309);
  drawn.segment(0, first, false), drawn.segment(first, second, false), drawn.segment(second, third, false);
  drawn.segment(third, first, false);
}

// The same costs, lane by lane until nothing gets cheaper.
std::vector<double> by_rounds(const MapView& map, const std::vector<double>& costs, std::uint32_t from, bool back) {
  std::vector<double> least(map.station_count(), INFINITY);
  least[from] = 0.0;
  for (bool more = true; more;) {
    more = false;
    for (std::uint32_t lane = 0; lane < map.lane_count(); ++lane) {
      const std::uint32_t here = back ? map.lane(lane).to : map.lane(lane).from;
      const std::uint32_t to = back ? map.lane(lane).from : map.lane(lane).to;
      if (least[here] + costs[lane] < least[to]) least[to] = least[here] + costs[lane], more = true;
    }
  }
  return least;
}

TEST(LeastCosts, AreThoseOfASearchWithoutRuns) {
  std::mt19937 random(7);
  for (std::uint32_t round = 0; round < 40; ++round) {
    DrawnMap drawn;
    draw(drawn, random);
    const MapView map(drawn.map());
    std::vector<double> costs;
    for (std::uint32_t lane = 0; lane < map.lane_count(); ++lane)
      costs.push_back(random() % 20 == 0 ? INFINITY : random() % 20 == 1 ? 0.0 : map.lane(lane).length_m / 3.0);
    for (const bool back : {false, true}) {
      LeastCosts least(map, costs, back);
      for (std::uint32_t lane = 0; lane < map.lane_count(); lane += 7) {
        if (std::isinf(costs[lane])) continue;
        costs[lane] = 8.0 * costs[lane] + 0.1;
        least.change(lane, costs[lane]);
      }
      const auto bytes = least.bytes();
      const LeastCosts read{std::span<const std::byte>(bytes)};
      for (std::uint32_t from = 0; from < map.station_count(); ++from) {
        const std::vector<double> expected = by_rounds(map, costs, from, back);
        EXPECT_EQ(least.from(from), expected) << round << ": " << from;
        EXPECT_EQ(read.from(from), expected) << round << ": " << from << ", from the bytes";
      }
    }
  }
}

}  // namespace
}  // namespace fleetproof::agents::least_costs_test
