#include "core/agents/routes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/agents/fleet.hpp"
#include "drawn_map.hpp"

namespace fleetproof::agents::routes_test {
namespace {

// 6 x 5 stations in a grid with every third segment one-way, and lanes that all cost 1, 2 or 3: many ways tie.
struct TiedGrid {
  testing::DrawnMap map;
  std::vector<double> cost_s;

  TiedGrid() {
    std::uint32_t number = 0;
    for (std::uint32_t i = 0; i < 30; ++i) map.station(4.0 * (i % 6), 4.0 * (i / 6));
    for (std::uint32_t i = 0; i < 30; ++i) {
      if (i % 6 != 5) map.segment(i, i + 1, ++number % 3 != 0);
      if (i + 6 < 30) map.segment(i + 6, i, ++number % 3 != 0);
    }
    for (std::uint32_t lane = 0; lane < map.map().lane_count; ++lane) cost_s.push_back(1.0 + lane % 3);
  }
};

TEST(Routes, ASearchThatStopsEarlyFindsTheWayOfAWholeSearch) {
  TiedGrid grid;
  const MapView view(grid.map.map());
  const DriveRules rules(view, 0);
  Routes whole(view, rules), early(view, rules);
  for (std::uint32_t from = 0; from < 30; ++from) {
    whole.search(from, {1.0, 0.0}, grid.cost_s);
    for (std::uint32_t to = 0; to < 30; ++to) {
      early.search(from, {1.0, 0.0}, grid.cost_s, to);
      const auto a = whole.lanes(to), b = early.lanes(to);
      EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end())) << from << " to " << to;
      EXPECT_EQ(whole.cost_s(to), early.cost_s(to));
    }
  }
}

TEST(LaneSpeed, IsThatOfTheDirection) {
  testing::DrawnMap map;
  map.station(0.0, 0.0), map.station(10.0, 0.0);
  map.segment(0, 1);
  map.drive_backward(1);
  const MapView view(map.map());
  fp_agv agv = testing::kTestAgv;  // 2 m/s forward
  EXPECT_EQ(lane_speed_mps(view, 1, agv), 2.0);
  for (const double reverse_mps : {0.5, 3.0}) {
    agv.reverse_speed_mps = reverse_mps;
    EXPECT_EQ(lane_speed_mps(view, 0, agv), 2.0);
    EXPECT_EQ(lane_speed_mps(view, 1, agv), reverse_mps);
  }
}

// A host of an older minor tells no speed of driving backward.
TEST(HighestSpeed, IsThatOfTheQuickerDirection) {
  fp_agv agv = testing::kTestAgv;
  agv.reverse_speed_mps = 3.0;
  fp_facts told{};
  told.fleet = &agv;
  told.agv_stride = sizeof(fp_agv);
  EXPECT_EQ(highest_speed_mps(told, 0), 3.0);
  told.agv_stride = offsetof(fp_agv, centre_ahead_m);
  EXPECT_EQ(highest_speed_mps(told, 0), 2.0);
  agv.reverse_speed_mps = 0.5;
  told.agv_stride = sizeof(fp_agv);
  EXPECT_EQ(highest_speed_mps(told, 0), 2.0);
}

// Against Bellman and Ford, which relax every lane as often as there are stations.
TEST(Routes, CostsAreTheLeastOfAllWays) {
  TiedGrid grid;
  const MapView view(grid.map.map());
  const DriveRules rules(view, 0);
  Routes routes(view, rules);
  for (std::uint32_t from = 0; from < 30; ++from) {
    std::vector<double> least(30, INFINITY);
    least[from] = 0.0;
    for (int round = 0; round < 30; ++round) {
      for (std::uint32_t lane = 0; lane < grid.cost_s.size(); ++lane) {
        const fp_lane& way = grid.map.lane_at(lane);
        least[way.to] = std::min(least[way.to], least[way.from] + grid.cost_s[lane]);
      }
    }
    routes.search(from, {1.0, 0.0}, grid.cost_s);
    for (std::uint32_t to = 0; to < 30; ++to) EXPECT_EQ(routes.cost_s(to), least[to]) << from << " to " << to;
  }
}

// Half of what remains, and nothing at some stations: a bound that is neither exact nor consistent.
TEST(Routes, ASearchWithABoundFindsAWayThatCostsTheLeast) {
  TiedGrid grid;
  const MapView view(grid.map.map());
  const DriveRules rules(view, 0);
  Routes whole(view, rules), bounded(view, rules);
  for (std::uint32_t to = 0; to < 30; ++to) {
    std::vector<float> remains(30);
    for (std::uint32_t from = 0; from < 30; ++from) {
      whole.search(from, {1.0, 0.0}, grid.cost_s);
      remains[from] = from % 4 == 1 ? 0.0F : static_cast<float>(whole.cost_s(to)) / (from % 3 == 0 ? 1.0F : 2.0F);
    }
    for (std::uint32_t from = 0; from < 30; ++from) {
      whole.search(from, {1.0, 0.0}, grid.cost_s);
      bounded.search_towards(to, remains, from, {1.0, 0.0}, grid.cost_s);
      EXPECT_EQ(whole.cost_s(to), bounded.cost_s(to)) << from << " to " << to;
      double sum = 0.0;
      for (const std::uint32_t lane : bounded.lanes(to)) sum += grid.cost_s[lane];
      EXPECT_EQ(sum, whole.cost_s(to)) << from << " to " << to;
    }
  }
}

TEST(Routes, ASearchForAGoalFarAwayEndsAtTheFirstStationThatIsFar) {
  testing::DrawnMap street;
  for (std::uint32_t i = 0; i < 40; ++i) street.station(5.0 * i, 0.0);
  for (std::uint32_t i = 0; i < 39; ++i) street.segment(i, i + 1);
  const MapView view(street.map());
  const DriveRules rules(view, 0);
  Routes routes(view, rules);
  const std::vector<double> cost_s(street.map().lane_count, 1.0);
  const std::vector<float> remains_s(40, 0.0F);
  const auto end = [&](std::uint32_t until, double far_m) {
    routes.search_towards(until, remains_s, 3, {1.0, 0.0}, cost_s, far_m);
    return routes.reached();
  };
  EXPECT_EQ(end(39, 70.0), 3U + 14U);
  EXPECT_EQ(routes.lanes(routes.reached()).size(), 14U);
  EXPECT_EQ(end(12, 70.0), 12U) << "the goal is nearer";
  EXPECT_EQ(end(39, INFINITY), 39U);
}

TEST(Routes, ShowsTheCheapestStationsFirstUntilItIsEnough) {
  TiedGrid grid;
  const MapView view(grid.map.map());
  const DriveRules rules(view, 0);
  Routes whole(view, rules), some(view, rules);
  whole.search(7, {1.0, 0.0}, grid.cost_s);
  std::vector<std::uint32_t> shown;
  const auto enough = [&](std::uint32_t station, double cost_s) {
    EXPECT_EQ(cost_s, whole.cost_s(station));
    EXPECT_TRUE(shown.empty() || cost_s >= whole.cost_s(shown.back()));
    shown.push_back(station);
    return shown.size() == 12;
  };
  some.search_until(enough, 7, {1.0, 0.0}, grid.cost_s);
  ASSERT_EQ(shown.size(), 12U);
  EXPECT_EQ(shown.front(), 7U);
  for (std::uint32_t station = 0; station < 30; ++station) {
    const bool was_shown = std::ranges::find(shown, station) != shown.end();
    EXPECT_TRUE(was_shown || whole.cost_s(station) >= whole.cost_s(shown.back())) << station;
    const auto a = whole.lanes(station), b = some.lanes(station);
    EXPECT_TRUE(!was_shown || std::equal(a.begin(), a.end(), b.begin(), b.end())) << station;
  }
}

}  // namespace
}  // namespace fleetproof::agents::routes_test
