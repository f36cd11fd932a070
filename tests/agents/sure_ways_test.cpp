#include "core/agents/sure_ways.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "core/agents/waiting_places.hpp"
#include "tests/agents/drawn_map.hpp"

namespace fleetproof::agents::sure_ways_test {
namespace {

using testing::DrawnMap;
using testing::TestFleet;

// A grid with lanes left out, many of them one-way; far enough apart that an AGV blocks no lane beside it. Some of its
// stations have a purpose.
void draw(DrawnMap& drawn, std::uint32_t seed) {
  constexpr std::uint32_t kSide = 9;
  std::mt19937 random(seed);
  for (std::uint32_t i = 0; i < kSide * kSide; ++i)
    drawn.station(8.0 * (i % kSide), 8.0 * (i / kSide), random() % 3 == 0 ? FP_STORAGE : FP_ROUTING);
  const auto connect = [&](std::uint32_t a, std::uint32_t b) {
    const std::uint32_t kind = random() % 8;
    if (kind < 4) drawn.segment(a, b);
    if (kind == 4 || kind == 5) drawn.segment(a, b, false);
    if (kind == 6) drawn.segment(b, a, false);
  };
  for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
    if (i % kSide + 1 < kSide) connect(i, i + 1);
    if (i + kSide < kSide * kSide) connect(i, i + kSide);
  }
}

template <class F>
void for_each_map(F look) {
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    DrawnMap drawn;
    draw(drawn, seed);
    look(seed, drawn, MapView(drawn.map()));
  }
}

// What `from` reaches, or what reaches it, without a station and some lanes.
std::vector<bool> reached(const MapView& map, std::uint32_t from, bool backwards, std::uint32_t without,
                          const std::vector<std::uint32_t>& lanes = {}) {
  std::vector<bool> found(map.station_count(), false);
  std::vector<std::uint32_t> open{from};
  found[from] = true;
  while (!open.empty()) {
    const std::uint32_t at = open.back();
    open.pop_back();
    for (const std::uint32_t lane : backwards ? map.lanes_to(at) : map.lanes_from(at)) {
      const std::uint32_t to = backwards ? map.lane(lane).from : map.lane(lane).to;
      if (to == without || found[to] || std::ranges::count(lanes, lane) > 0) continue;
      found[to] = true;
      open.push_back(to);
    }
  }
  return found;
}

TEST(SureWays, AreSureOfNothingThatASearchDenies) {
  std::size_t sure = 0, missed = 0;
  for_each_map([&](std::uint32_t seed, DrawnMap&, const MapView& map) {
    const auto there = reached(map, 40, false, FP_NONE), back = reached(map, 40, true, FP_NONE);
    std::vector<std::uint32_t> roots;
    for (std::uint32_t id = 0; id < map.station_count(); id += 20) {
      if (there[id] && back[id]) roots.push_back(id);
    }
    if (roots.empty()) return;
    const auto tables = SureWays::work_out(map, roots);
    SureWays ways(map, tables);
    for (std::uint32_t station = 0; station < map.station_count(); ++station) {
      const std::vector<std::uint32_t> lanes{station, (7 * station + 1) % map.lane_count()};
      ways.take_away(station, lanes);
      for (const std::uint32_t root : roots) {
        if (root == station || !ways.is_sure(root, false) || !ways.is_sure(root, true)) continue;
        const auto from = reached(map, root, false, station, lanes), to = reached(map, root, true, station, lanes);
        for (std::uint32_t id = 0; id < map.station_count(); ++id) {
          EXPECT_TRUE(to[id] || !ways.is_sure(id, false)) << seed << ": " << id << " without " << station;
          EXPECT_TRUE(from[id] || !ways.is_sure(id, true)) << seed << ": " << id << " without " << station;
          sure += ways.is_sure(id, false) && to[id] ? 1 : 0;
          missed += !ways.is_sure(id, false) && to[id] ? 1 : 0;
        }
      }
      EXPECT_FALSE(ways.is_sure(station, false)) << "it is missing itself";
    }
  });
  EXPECT_GT(sure, 20 * missed) << "else they spare no search";
}

// Whatever is known without a search: the burden is what no other station is connected with any more.
TEST(SureWays, LeaveTheJudgementOfWaitingPlacesAsItIs) {
  std::size_t judged = 0, burdens = 0;
  for_each_map([&](std::uint32_t seed, DrawnMap& drawn, const MapView& map) {
    const TestFleet fleet(drawn.map(), 2);
    HullGeometry geometry(map, fleet.briefing(0, 0));
    WaitingPlaces places(map, geometry);
    for (std::uint32_t station = 0; station < map.station_count(); ++station) {
      std::uint32_t others = 0, largest = 0;
      std::vector<bool> part;
      for (std::uint32_t id = 0; id < map.station_count(); ++id) {
        if (id == station || map.station(id).purposes == FP_ROUTING) continue;
        ++others;
        auto both = reached(map, id, false, station);
        const auto back = reached(map, id, true, station);
        std::uint32_t goals = 0;
        for (std::uint32_t to = 0; to < map.station_count(); ++to) {
          both[to] = both[to] && back[to];
          goals += both[to] && map.station(to).purposes != FP_ROUTING ? 1 : 0;
        }
        if (goals > largest) largest = goals, part = both;
      }
      bool two_way = false, beside = false;  // the largest part is sought beside the station
      for (const std::uint32_t lane : map.lanes_from(station))
        two_way = two_way || map.two_way(lane), beside = beside || part[map.lane(lane).to];
      for (const std::uint32_t lane : map.lanes_to(station))
        two_way = two_way || map.two_way(lane), beside = beside || part[map.lane(lane).from];
      if (!beside) continue;
      EXPECT_EQ(places.burden(station), two_way ? others - largest : 0) << seed << ": " << station;
      ++judged;
      burdens += two_way && others > largest ? 1 : 0;
    }
  });
  EXPECT_GT(judged, 1'000U);
  EXPECT_GT(burdens, 100U);
}

}  // namespace
}  // namespace fleetproof::agents::sure_ways_test
