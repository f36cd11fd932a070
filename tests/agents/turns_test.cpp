#include "core/agents/turns.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/agents/drawn_map.hpp"

namespace fleetproof::agents {
namespace {

// A junction with lanes to the four sides, one more that leaves by 30 degrees, and a station on a straight lane.
class TurnsTest : public ::testing::Test {
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
  Turns turns{map};
};

TEST_F(TurnsTest, EachPairOfHeadingsHasOneNumberInBothDirections) {
  const std::uint32_t left = turns.number_of(0, end(3, 0), start(0, 2));
  EXPECT_FALSE(turns.is_any(left));
  EXPECT_EQ(turns.station_of(left), 0U);
  EXPECT_EQ(turns.number_of(0, end(4, 0), start(0, 1)), left) << "from north to east, the same floor";
  std::set<std::uint32_t> numbers;
  for (std::uint32_t from = 1; from <= 4; ++from) {
    for (std::uint32_t to = 1; to <= 5; ++to) numbers.insert(turns.number_of(0, end(from, 0), start(0, to)));
  }
  EXPECT_EQ(numbers.size(), 1 + 4 + 3U)
      << "any turn, four quarters, and three to the fifth lane that are not too large";
  EXPECT_EQ(turns.count(), map.station_count() + 4 + 3);
}

TEST_F(TurnsTest, HalfTurnsAndHeadingsOfNoLaneAreAnyTurn) {
  EXPECT_EQ(turns.number_of(0, end(3, 0), start(0, 3)), 0U) << "back";
  EXPECT_EQ(turns.number_of(0, {0.6, 0.8}, start(0, 1)), 0U) << "a start heading beside the lanes";
  EXPECT_EQ(turns.number_of(1, end(0, 1), start(1, 0)), 1U);
  EXPECT_TRUE(turns.is_any(1));
  EXPECT_EQ(turns.station_of(1), 1U);
}

TEST_F(TurnsTest, AHeadingThatMessagesRoundIsTheSame) {
  const Vec exact = end(3, 0), rounded = turned(exact, 1e-4);
  EXPECT_EQ(turns.number_of(0, rounded, start(0, 2)), turns.number_of(0, exact, start(0, 2)));
}

TEST_F(TurnsTest, TheSameFromItsTables) {
  TableWriter writer;
  turns.add_to(writer);
  TableReader reader(writer.bytes());
  const Turns read(reader);
  ASSERT_EQ(read.count(), turns.count());
  for (std::uint32_t number = 0; number < turns.count(); ++number)
    EXPECT_EQ(read.station_of(number), turns.station_of(number));
  EXPECT_EQ(read.number_of(0, end(3, 0), start(0, 2)), turns.number_of(0, end(3, 0), start(0, 2)));
}

}  // namespace
}  // namespace fleetproof::agents
