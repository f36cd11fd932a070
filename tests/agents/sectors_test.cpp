#include "core/agents/sectors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/agents/drawn_map.hpp"

namespace fleetproof::agents::sectors_test {
namespace {

// A junction with lanes to the four sides, one more that leaves by 30 degrees, and a station on a straight lane.
class SectorsTest : public ::testing::Test {
 protected:
  Vec end(std::uint32_t from, std::uint32_t to) const { return map.end_heading(drawn.lane_between(from, to)); }
  Vec start(std::uint32_t from, std::uint32_t to) const { return map.start_heading(drawn.lane_between(from, to)); }

  testing::DrawnMap drawn = [] {
    testing::DrawnMap d;
    for (const auto& [x, y] : {std::pair(0.0, 0.0), {5.0, 0.0}, {0.0, 5.0}, {-5.0, 0.0}, {0.0, -5.0}, {4.33, 2.5}})
      d.station(x, y);
    for (std::uint32_t side = 1; side <= 4; ++side) d.segment(0, side);
    d.segment(0, 5, false);
    d.segment(1, d.station(9.0, 0.0));
    return d;
  }();
  MapView map{drawn.map()};
  Sectors sectors{map};
};

TEST_F(SectorsTest, EachPairOfHeadingsHasOneInBothDirections) {
  const std::uint32_t left = sectors.find(0, end(3, 0), start(0, 2));
  ASSERT_NE(left, FP_NONE);
  EXPECT_EQ(sectors[left].station, 0U);
  EXPECT_EQ(sectors.find(0, end(4, 0), start(0, 1)), left) << "from north to east, the same floor";
  std::set<std::uint32_t> numbers;
  for (std::uint32_t from = 1; from <= 4; ++from) {
    for (std::uint32_t to = 1; to <= 5; ++to) numbers.insert(sectors.find(0, end(from, 0), start(0, to)));
  }
  numbers.erase(FP_NONE);
  EXPECT_EQ(numbers.size(), 4 + 3U) << "four quarters, and three to the fifth lane that are not too large";
  EXPECT_EQ(sectors.count(), 4 + 3U);
}

TEST_F(SectorsTest, HalfTurnsAndHeadingsOfNoLaneHaveNone) {
  EXPECT_EQ(sectors.find(0, end(3, 0), start(0, 3)), FP_NONE) << "back";
  EXPECT_EQ(sectors.find(0, {0.6, 0.8}, start(0, 1)), FP_NONE) << "a start heading beside the lanes";
  EXPECT_EQ(sectors.find(1, end(0, 1), start(1, 0)), FP_NONE);
}

// A restarted agent, which does not know from where its AGV turns, takes the opposite of where it turns to.
TEST_F(SectorsTest, OppositeHeadingsNeverHaveOne) {
  for (std::uint32_t lane = 0; lane < map.lane_count(); ++lane) {
    const Vec heading = map.start_heading(lane);
    EXPECT_EQ(sectors.find(map.lane(lane).from, heading * -1.0, heading), FP_NONE) << lane;
  }
}

TEST_F(SectorsTest, AHeadingThatMessagesRoundIsTheSame) {
  const Vec exact = end(3, 0), rounded = turned(exact, 1e-4);
  EXPECT_EQ(sectors.find(0, rounded, start(0, 2)), sectors.find(0, exact, start(0, 2)));
}

TEST_F(SectorsTest, TheSameFromItsTables) {
  TableWriter writer;
  sectors.add_to(writer);
  TableReader reader(writer.bytes());
  const Sectors read(reader);
  ASSERT_EQ(read.count(), sectors.count());
  for (std::uint32_t number = 0; number < sectors.count(); ++number)
    EXPECT_EQ(read[number].station, sectors[number].station);
  EXPECT_EQ(read.find(0, end(3, 0), start(0, 2)), sectors.find(0, end(3, 0), start(0, 2)));
}

// AGVs come along the first lane nose first and back out along the second one: by the noses, a turn of 30 degrees.
TEST(Sectors, HeadingsAreThoseOfTheNoses) {
  testing::DrawnMap drawn;
  drawn.station(-5, 0), drawn.station(0, 0), drawn.station(-4.33, 2.5);
  drawn.segment(0, 1, false), drawn.segment(1, 2, false);
  drawn.drive_backward(1);
  const MapView map(drawn.map());
  const Sectors sectors(map);
  ASSERT_EQ(sectors.count(), 1U);
  EXPECT_NEAR(dot(sectors[0].from, sectors[0].to), std::cos(M_PI / 6.0), 1e-3);
  EXPECT_EQ(sectors.find(1, map.end_heading(0), map.start_heading(1)), 0U);
}

TEST(Sectors, HubsHaveNone) {
  for (const auto& [lanes, some] : {std::pair(10, true), {60, false}}) {
    testing::DrawnMap drawn;
    drawn.station(0, 0);
    for (int i = 0; i < lanes; ++i)
      drawn.segment(0, drawn.station(5.0 * std::cos(0.1 * i), 5.0 * std::sin(0.1 * i)), false);
    EXPECT_EQ(Sectors(MapView(drawn.map())).count() > 0, some);
  }
}

}  // namespace
}  // namespace fleetproof::agents::sectors_test
