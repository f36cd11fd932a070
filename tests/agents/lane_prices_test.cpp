#include "core/agents/lane_prices.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "tests/agents/drawn_map.hpp"

namespace fleetproof::agents::lane_prices_test {
namespace {

using testing::DrawnMap;

constexpr std::uint32_t kManyAgvs = 1000, kNoAgvs = 0;  // the map has few or many lanes for each

// A street of three segments, the last one long, and a one-way lane back to its middle.
DrawnMap draw_street() {
  DrawnMap drawn;
  for (const double y_m : {0.0, 2.0, 3.0, 13.0}) drawn.station(0, y_m);
  for (std::uint32_t i = 0; i < 3; ++i) drawn.segment(i, i + 1);
  drawn.segment(3, 1, false);
  return drawn;
}

struct Street {
  DrawnMap drawn = draw_street();
  MapView map{drawn.map()};
  DriveRules rules{map, 0};
  std::vector<double> usual_s{1, 2, 3, 4, 5, 6, 7};

  Path drive(std::initializer_list<std::uint32_t> stations) const {
    Path path;
    path.station = *stations.begin();
    for (const std::uint32_t* at = stations.begin(); at + 1 != stations.end(); ++at)
      path.append(drawn.lane_between(at[0], at[1]));
    return path;
  }
};

std::vector<double> now_s(const LanePrices& prices) { return {prices.costs_s().begin(), prices.costs_s().end()}; }

TEST(LanePrices, WhomAnAgvMeetsIsDearForEachMetreUpToAMinute) {
  Street street;
  LanePrices prices(street.map, street.rules, street.usual_s, kManyAgvs);
  prices.begin(false);
  EXPECT_EQ(now_s(prices), street.usual_s);
  prices.price_meetings(street.drive({0, 1, 2, 3, 1}));
  std::vector<double> expected = street.usual_s;
  expected[street.drawn.lane_between(1, 0)] += 30.0;
  expected[street.drawn.lane_between(2, 1)] += 15.0;
  expected[street.drawn.lane_between(3, 2)] += 60.0;  // nobody meets it on the one-way lane
  EXPECT_EQ(now_s(prices), expected);
}

TEST(LanePrices, AStationIsDearForThoseThatArriveAndThoseThatLeave) {
  Street street;
  LanePrices prices(street.map, street.rules, street.usual_s, kManyAgvs);
  prices.begin(false);
  prices.price_station(3, 8.0);
  std::vector<double> expected = street.usual_s;
  for (const auto& [from, to] : {std::pair{2U, 3U}, {3U, 2U}, {3U, 1U}})
    expected[street.drawn.lane_between(from, to)] += 8.0;
  EXPECT_EQ(now_s(prices), expected);
}

// Forward and backward are two lanes of one segment and direction.
TEST(LanePrices, WhomAnAgvMeetsIsDearOnAllLanesOfTheSegment) {
  DrawnMap drawn;
  drawn.station(0, 0), drawn.station(0, 1);
  drawn.segment(0, 1);
  drawn.beside(0, 1);
  const MapView map(drawn.map());
  const std::vector<double> usual_s{1, 2, 3};
  const DriveRules rules(map, 0);
  LanePrices prices(map, rules, usual_s, kManyAgvs);
  prices.begin(false);
  Path back;
  back.station = 1;
  back.append(drawn.lane_between(1, 0));
  prices.price_meetings(back);
  EXPECT_EQ(now_s(prices), (std::vector<double>{16, 2, 18}));
}

// To the bit: of sums in another order, some would differ.
TEST(LanePrices, AreForgottenWhetherTheyAreRememberedOrNot) {
  Street street;
  for (double& cost_s : street.usual_s) cost_s /= 3.0;
  LanePrices anew(street.map, street.rules, street.usual_s, kManyAgvs),
      remembering(street.map, street.rules, street.usual_s, kNoAgvs);
  std::mt19937 bits(1);
  for (int round = 0; round < 50; ++round) {
    for (LanePrices* const prices : {&anew, &remembering}) prices->begin(round % 3 == 0);
    ASSERT_EQ(now_s(remembering), street.usual_s);
    for (int i = 0; i < 20; ++i) {
      const auto station = static_cast<std::uint32_t>(bits() % street.map.station_count());
      const Path way = i % 2 == 0 ? street.drive({0, 1, 2, 3, 1, 2}) : street.drive({3, 2, 1});
      const bool drives = bits() % 3 == 0;
      for (LanePrices* const prices : {&anew, &remembering}) {
        prices->price_station(station, 0.1 * i);
        if (drives) prices->price_meetings(way);
      }
    }
    ASSERT_EQ(now_s(remembering), now_s(anew));
  }
}

}  // namespace
}  // namespace fleetproof::agents::lane_prices_test
