#include "core/agents/aisles.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/agents/drawn_map.hpp"

namespace fleetproof::agents::aisles_test {
namespace {

using testing::DrawnMap;

constexpr std::uint32_t kStops = 6;      // of each aisle
constexpr std::uint32_t kCrowd = 30;     // an aisle then holds several AGVs, wherever it is
constexpr std::uint32_t kAisleFrom = 4;  // stations 0 to 3 are the corners of the ring

// Two aisles side by side between a street to the west in the south, and one to the east in the north. A lane back on
// the eastern side closes the ring, and a bay lies beside the first aisle.
//   2 <- 3       north, from the west: 1 -> (top of each aisle) -> 2
//   |    |
//   0 <- ...     south, from the east: 3 -> (bottom of each aisle) -> 0
struct TwoAisles {
  explicit TwoAisles(bool both_ways_round = false, std::uint32_t stops = FP_STORAGE) {
    drawn.station(-8, 0), drawn.station(-8, 20), drawn.station(16, 20), drawn.station(16, 0);
    for (const double x : {0.0, 8.0}) {
      for (std::uint32_t i = 0; i < kStops; ++i) drawn.station(x, 4.0 * i, stops);
    }
    bay = drawn.station(-3, 8, FP_STORAGE);
    for (const std::uint32_t aisle : {0U, 1U}) {
      for (std::uint32_t i = 0; i + 1 < kStops; ++i) drawn.segment(stop(aisle, i), stop(aisle, i + 1));
    }
    drawn.segment(stop(0, 2), bay);
    const std::vector<std::uint32_t> round{0,          1, stop(0, kStops - 1), stop(1, kStops - 1), 2, 3, stop(1, 0),
                                           stop(0, 0), 0};
    for (std::size_t i = 0; i + 1 < round.size(); ++i) drawn.segment(round[i], round[i + 1], both_ways_round);
    drawn.map();
  }
  std::uint32_t stop(std::uint32_t aisle, std::uint32_t i) const { return kAisleFrom + aisle * kStops + i; }
  std::uint32_t lane(std::uint32_t from, std::uint32_t to) const { return drawn.lane_between(from, to); }

  DrawnMap drawn;
  std::uint32_t bay = 0;
};

// Stations that are reached without a lane against the convention.
std::uint32_t reached(const MapView& map, const Aisles& aisles, std::uint32_t from) {
  std::vector<bool> seen(map.station_count(), false);
  std::vector<std::uint32_t> open{from};
  std::uint32_t count = 0;
  while (!open.empty()) {
    const std::uint32_t here = open.back();
    open.pop_back();
    if (seen[here]) continue;
    seen[here] = true;
    ++count;
    for (const std::uint32_t lane : map.lanes_from(here)) {
      if (!aisles.is_against(lane)) open.push_back(map.lane(lane).to);
    }
  }
  return count;
}

TEST(Aisles, EachGetsOneDirectionAndAllStationsStillReachEachOther) {
  for (const bool both_ways_round : {false, true}) {
    TwoAisles plant(both_ways_round);
    const MapView map(plant.drawn.map());
    const Aisles aisles(map, kCrowd);
    for (const std::uint32_t aisle : {0U, 1U}) {
      const bool up_is_against = aisles.is_against(plant.lane(plant.stop(aisle, 0), plant.stop(aisle, 1)));
      for (std::uint32_t i = 0; i + 1 < kStops; ++i) {
        const std::uint32_t here = plant.stop(aisle, i), above = plant.stop(aisle, i + 1);
        EXPECT_EQ(aisles.is_against(plant.lane(here, above)), up_is_against) << "the whole aisle, past the bay";
        EXPECT_EQ(aisles.is_against(plant.lane(above, here)), !up_is_against);
      }
    }
    for (std::uint32_t from = 0; from < map.station_count(); ++from)
      EXPECT_EQ(reached(map, aisles, from), map.station_count()) << from;
  }
}

TEST(Aisles, ABayIsLeftByTheWayIntoIt) {
  TwoAisles plant;
  const MapView map(plant.drawn.map());
  const Aisles aisles(map, kCrowd);
  EXPECT_FALSE(aisles.is_against(plant.lane(plant.stop(0, 2), plant.bay)));
  EXPECT_FALSE(aisles.is_against(plant.lane(plant.bay, plant.stop(0, 2))));
}

TEST(Aisles, TheyAreTwoWayIfAgvsStopInBaysOnly) {
  TwoAisles plant(false, FP_ROUTING);
  const MapView map(plant.drawn.map());
  const Aisles aisles(map, kCrowd);
  for (std::uint32_t lane = 0; lane < map.lane_count(); ++lane) EXPECT_FALSE(aisles.is_against(lane)) << lane;
}

TEST(Aisles, InASmallFleetTheyAreTwoWay) {
  TwoAisles plant;
  const MapView map(plant.drawn.map());
  const Aisles aisles(map, 1);
  for (std::uint32_t lane = 0; lane < map.lane_count(); ++lane) EXPECT_FALSE(aisles.is_against(lane)) << lane;
}

// The only way between two halves: each direction is needed.
TEST(Aisles, WithoutAWayRoundTheyAreTwoWay) {
  DrawnMap drawn;
  for (std::uint32_t i = 0; i < 8; ++i) drawn.station(4.0 * i, 0);
  for (std::uint32_t i = 0; i + 1 < 8; ++i) drawn.segment(i, i + 1);
  for (const auto& [end, x] : {std::pair(0U, -4.0), {7U, 32.0}}) {
    const auto corner = drawn.station(x, 4), other = drawn.station(x, -4);
    drawn.segment(end, corner, false), drawn.segment(corner, other, false), drawn.segment(other, end, false);
  }
  const MapView map(drawn.map());
  const Aisles aisles(map, kCrowd);
  for (std::uint32_t lane = 0; lane < map.lane_count(); ++lane) EXPECT_FALSE(aisles.is_against(lane)) << lane;
}

}  // namespace
}  // namespace fleetproof::agents::aisles_test
