// The book of the zone-server: who may use which floor, whatever the radio does to messages.
#include "core/agents/central/floor_book.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "core/agents/hull.hpp"
#include "core/agents/map_view.hpp"
#include "tests/agents/drawn_map.hpp"

namespace fleetproof::agents::central::floor_book_test {
namespace {

using testing::DrawnMap;
using testing::TestFleet;

// Five stations in a row, 6 m apart. AGV 0 stands at station 0, AGV 1 at station 4.
struct Row {
  Row() {
    for (int i = 0; i < 5; ++i) drawn.station(6.0 * i, 0);
    for (std::uint32_t i = 0; i < 4; ++i) drawn.segment(i, i + 1);
    drawn.map();
  }
  Step lane(std::uint32_t from, std::uint32_t to) const { return {Step::Kind::Drive, drawn.lane_between(from, to)}; }

  DrawnMap drawn;
};

State standing(std::uint32_t station, WayNumber way = {}) {
  State state;
  state.way = way;
  state.stands = true;
  state.station = station;
  state.number = 1;
  return state;
}

class FloorBookInARow : public ::testing::Test {
 protected:
  using News = FloorBook::News;

  void join_both() {
    EXPECT_EQ(book.hear(0, standing(0)), News::Joined);
    EXPECT_EQ(book.hear(1, standing(4)), News::Joined);
  }
  bool grant(std::uint32_t agv, std::vector<Step> steps) { return book.grant(agv, steps); }
  // AGV 0 says that it has so many steps, and has left so many behind.
  News hear_of(std::uint32_t known, std::uint32_t done, std::uint32_t number, WayNumber way = {}) {
    State state = standing(0, way);
    state.known = known, state.done = done, state.number = number;
    return book.hear(0, state);
  }

  Row row;
  TestFleet fleet{row.drawn.map(), 2};
  MapView map{row.drawn.map()};
  HullGeometry geometry{map, fleet.briefing(0, 0)};
  FloorBook book{map, geometry, 2, 0};
};

TEST_F(FloorBookInARow, GrantsNothingBeforeAllHaveJoined) {
  book.hear(1, standing(4));
  EXPECT_FALSE(grant(1, {row.lane(4, 3)}));
  State moves = standing(0);
  moves.stands = false;
  EXPECT_EQ(book.hear(0, moves), News::None);
  EXPECT_FALSE(grant(1, {row.lane(4, 3)})) << "the other AGV does not rest yet";
  book.hear(0, standing(0));
  EXPECT_TRUE(grant(1, {row.lane(4, 3)}));
}

TEST_F(FloorBookInARow, GrantsEachFloorToOneAgv) {
  join_both();
  EXPECT_TRUE(grant(0, {row.lane(0, 1), row.lane(1, 2)}));
  EXPECT_FALSE(grant(1, {row.lane(4, 3), row.lane(3, 2)}));
  EXPECT_TRUE(book.way(1).steps.empty()) << "a refused grant changes nothing";
  EXPECT_TRUE(grant(1, {row.lane(4, 3)}));
  EXPECT_FALSE(grant(0, {row.lane(0, 1)})) << "its way ends elsewhere";
}

TEST_F(FloorBookInARow, FreesFloorOnlyWhenTheAgvSaysSo) {
  join_both();
  grant(0, {row.lane(0, 1), row.lane(1, 2), row.lane(2, 1)});
  EXPECT_EQ(hear_of(3, 0, 2), News::None);
  EXPECT_FALSE(grant(1, {row.lane(4, 3), row.lane(3, 2)}));
  EXPECT_EQ(hear_of(3, 3, 4), News::Progress);
  EXPECT_EQ(hear_of(2, 1, 3), News::None) << "an older message changes nothing";
  EXPECT_EQ(book.way(0).done, 3U);
  EXPECT_TRUE(grant(1, {row.lane(4, 3)}));
  EXPECT_FALSE(grant(1, {row.lane(3, 2), row.lane(2, 1)})) << "it stands there";
}

TEST_F(FloorBookInARow, RepeatsWhatIsNotKnown) {
  join_both();
  grant(0, {row.lane(0, 1), row.lane(1, 2)});
  EXPECT_EQ(book.unknown_steps(0).steps, (std::vector{row.lane(0, 1), row.lane(1, 2)}));
  hear_of(1, 0, 2);
  const Grant grant = book.unknown_steps(0);
  EXPECT_EQ(grant.first, 1U);
  EXPECT_EQ(grant.steps, std::vector{row.lane(1, 2)});
  hear_of(2, 1, 3);
  EXPECT_TRUE(book.unknown_steps(0).steps.empty());
}

TEST_F(FloorBookInARow, ARestartedAgvBeginsAWayWhereItStands) {
  join_both();
  grant(0, {row.lane(0, 1), row.lane(1, 2)});
  State again = standing(1, {0, 1});
  EXPECT_EQ(book.hear(0, again), News::Joined);
  EXPECT_EQ(book.number_of(0), (WayNumber{0, 1}));
  EXPECT_TRUE(book.way(0).steps.empty());
  EXPECT_TRUE(grant(0, {row.lane(1, 0)}));
  EXPECT_EQ(hear_of(2, 2, 9), News::None) << "a late message of its former self";
  EXPECT_EQ(book.way(0).held.station, 1U);
  EXPECT_TRUE(grant(1, {row.lane(4, 3), row.lane(3, 2)}));
}

TEST_F(FloorBookInARow, AServerKnowsNothingOfItsFormerSelf) {
  FloorBook later(map, geometry, 2, 1);
  EXPECT_EQ(later.hear(0, standing(0)), News::None) << "said to the boot before";
  EXPECT_EQ(later.hear(1, standing(4, {1, 0})), News::Joined);
  EXPECT_FALSE(later.all_joined());
}

// The new book has the floor and the numbers of the old one, as it was when an AGV was told something last.
TEST_F(FloorBookInARow, GoesOnFromItsRecords) {
  join_both();
  ASSERT_TRUE(grant(0, {row.lane(0, 1), row.lane(1, 2), row.lane(2, 1)}));
  hear_of(3, 1, 2);
  FloorBook later(map, geometry, 2, 9);
  for (std::uint32_t agv = 0; agv < 2; ++agv) later.recall(agv, book.record_of(agv));
  EXPECT_TRUE(later.all_joined());
  EXPECT_EQ(later.server_boot(), 0U);
  EXPECT_EQ(later.way(0).granted(), 3U);
  EXPECT_FALSE(later.grant(1, std::vector{row.lane(4, 3), row.lane(3, 2)})) << "AGV 0 may be there";
  EXPECT_EQ(later.unknown_steps(0).first, 1U);
  EXPECT_EQ(later.unknown_steps(0).steps, (std::vector{row.lane(1, 2), row.lane(2, 1)}));
  State state = standing(0);
  state.known = state.done = 3, state.number = 3;
  EXPECT_EQ(later.hear(0, state), News::Progress);
  EXPECT_TRUE(later.grant(1, std::vector{row.lane(4, 3)}));
}

// Bodies are apart at the start, but the hulls of bodies with loads need not be.
TEST(FloorBookAtTheStart, LetsPickOnlyOnFloorOfItsOwn) {
  DrawnMap drawn;
  for (const double y_m : {0.0, 1.3}) drawn.segment(drawn.station(0, y_m), drawn.station(8, y_m));
  fp_agv agv = testing::kTestAgv;
  agv.loaded_width_m = 1.4;
  TestFleet fleet(drawn.map(), 2, agv);
  MapView map(drawn.map());
  HullGeometry geometry(map, fleet.briefing(0, 0));
  FloorBook book(map, geometry, 2, 0);
  book.hear(0, standing(0));
  book.hear(1, standing(2));
  EXPECT_FALSE(book.grant(0, std::vector{Step{Step::Kind::Pick, 7}}));
}

// ---- messages

TEST(CentralMessages, ComeBackAsTheyWere) {
  State state = standing(7, {3, 4});
  state.heading = {0.6, -0.8};
  state.load = 5, state.known = 9, state.done = 8, state.battery = 0.25, state.out_of_order = true;
  state.first_order = 2;
  state.orders = {{1, 2, 3}, {4, 5, 6}};
  const auto back = decode_as<State>(encode(state));
  ASSERT_TRUE(back);
  EXPECT_EQ(encode(*back), encode(state));
  EXPECT_EQ(back->orders, state.orders);
  EXPECT_EQ(back->way, state.way);
  EXPECT_EQ(back->battery, 0.25);
  const AgvRecord record{state, {{3, 4}, 9, {{Step::Kind::Pick, 5}}}, {{{4, {Step::Kind::Drop, 5}}}, 2, true}};
  const auto record_back = decode_as<AgvRecord>(encode(record));
  ASSERT_TRUE(record_back);
  EXPECT_EQ(encode(*record_back), encode(record));
  const Grant grant{{1, 2}, 3, {{Step::Kind::Drive, 4}, {Step::Kind::Drop, 5}}, 6};
  const auto grant_back = decode_as<Grant>(encode(grant));
  ASSERT_TRUE(grant_back);
  EXPECT_EQ(encode(*grant_back), encode(grant));
  EXPECT_EQ(grant_back->steps, grant.steps);
}

TEST(CentralMessages, AreReadCompletelyOrNotAtAll) {
  State state = standing(7);
  state.orders.resize(kMostOrdersInAMessage);
  Grant grant;
  grant.steps.resize(kMostStepsInAMessage);
  for (std::vector<std::byte> bytes : {encode(state), encode(grant)}) {
    EXPECT_LE(bytes.size(), FP_MESSAGE_BYTES_MAX);
    EXPECT_TRUE(decode_as<State>(bytes) || decode_as<Grant>(bytes));
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      const auto part = std::span(bytes).first(size);
      EXPECT_FALSE(decode_as<State>(part) || decode_as<Grant>(part)) << size;
    }
    bytes.push_back({});
    EXPECT_FALSE(decode_as<State>(bytes) || decode_as<Grant>(bytes));
  }
  state.heading = {2.0, 0.0};
  EXPECT_FALSE(decode_as<State>(encode(state))) << "no unit vector";
  state.heading = {1.0, 0.0};
  state.done = 1;
  EXPECT_FALSE(decode_as<State>(encode(state))) << "more done than known";
}

}  // namespace
}  // namespace fleetproof::agents::central::floor_book_test
