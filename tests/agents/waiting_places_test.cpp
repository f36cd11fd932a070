#include "core/agents/waiting_places.hpp"

#include <gtest/gtest.h>

#include "core/agents/section_planner.hpp"
#include "tests/agents/drawn_map.hpp"

namespace fleetproof::agents::waiting_places_test {
namespace {

using testing::DrawnMap;
using testing::TestFleet;

// A street of five stations with a siding beside its middle and a spur at station 1:
//            6---7
//           /     \            (siding: 2-6-7-4... in corners)
//   0---1---2---3---4---5
//       |
//       8
struct Street {
  Street() {
    for (int i = 0; i < 6; ++i) drawn.station(4.0 * i, 0);
    drawn.station(9, 3), drawn.station(15, 3), drawn.station(4, -3.5);
    for (std::uint32_t i = 0; i < 5; ++i) drawn.segment(i, i + 1);
    drawn.segment(2, 6), drawn.segment(6, 7), drawn.segment(7, 4), drawn.segment(1, 8);
    drawn.map();
  }
  DrawnMap drawn;
};

TEST(WaitingPlaces, AreWhereNobodyElseIsCutOff) {
  Street street;
  const MapView map(street.drawn.map());
  const TestFleet fleet(street.drawn.map(), 3);
  HullGeometry geometry(map, fleet.briefing(0, 0));
  WaitingPlaces places(map, geometry);
  for (const std::uint32_t safe : {0U, 3U, 5U, 6U, 7U, 8U}) EXPECT_TRUE(places.is_safe(safe)) << safe;
  EXPECT_EQ(places.burden(1), 2U) << "cuts off 0 and 8, one from the other and both from the rest";
  EXPECT_EQ(places.burden(2), 3U);
  EXPECT_EQ(places.burden(4), 1U);
}

TEST(WaitingPlaces, AreNotBesideALaneTooNear) {
  DrawnMap drawn;
  const auto a = drawn.station(0, 0), b = drawn.station(6, 0), c = drawn.station(3, 1.3), d = drawn.station(3, 6),
             e = drawn.station(12, 0);
  drawn.segment(a, b), drawn.segment(c, d), drawn.segment(d, e), drawn.segment(b, e), drawn.segment(a, d);
  const MapView map(drawn.map());
  const TestFleet fleet(drawn.map(), 2);
  HullGeometry geometry(map, fleet.briefing(0, 0));
  WaitingPlaces places(map, geometry);
  EXPECT_GE(places.burden(c), PlaceJudge::kFoulsLanes) << "turning there would reach into the lane a-b";
  EXPECT_TRUE(places.is_safe(e));
}

// In the bay, the AGV reaches into the lane in front of it. Nobody else has anything to do on that lane.
TEST(WaitingPlaces, AreInABayWhoseEntranceNobodyElseNeeds) {
  DrawnMap drawn;
  const auto west = drawn.station(0, 0, FP_STORAGE), middle = drawn.station(8, 0),
             east = drawn.station(16, 0, FP_STORAGE), entrance = drawn.station(8, -4),
             bay = drawn.station(8, -5.2, FP_STORAGE);
  drawn.segment(west, middle), drawn.segment(middle, east), drawn.segment(middle, entrance),
      drawn.segment(entrance, bay);
  const MapView map(drawn.map());
  const TestFleet fleet(drawn.map(), 2);
  HullGeometry geometry(map, fleet.briefing(0, 0));
  WaitingPlaces places(map, geometry);
  EXPECT_TRUE(places.is_safe(bay));
  EXPECT_EQ(places.burden(middle), 2U) << "one of three goals is left";
  EXPECT_EQ(places.burden(entrance), 1U) << "cuts off the bay";
}

TEST(WaitingPlaces, OnAOneWayLoopOnlyFollowersWait) {
  DrawnMap drawn;
  for (const auto& [x, y] : {std::pair(0, 0), {8, 0}, {8, 8}, {0, 8}}) drawn.station(x, y);
  for (std::uint32_t i = 0; i < 4; ++i) drawn.segment(i, (i + 1) % 4, false);
  const auto spur = drawn.station(12, 8);
  drawn.segment(2, spur);
  const MapView map(drawn.map());
  const TestFleet fleet(drawn.map(), 2);
  HullGeometry geometry(map, fleet.briefing(0, 0));
  WaitingPlaces places(map, geometry);
  EXPECT_TRUE(places.is_safe(0) && places.is_safe(1) && places.is_safe(3) && places.is_safe(spur));
  EXPECT_FALSE(places.is_safe(2)) << "who waits there locks in whoever is in the spur";
}

// Two one-way streets side by side, in opposite directions, with a dock beside each: `south` to the east, 0-1-2, and
// `north` to the west, 3-4-5. They meet beyond both ends.
struct Streets {
  explicit Streets(double apart_m) {
    for (int i = 0; i < 3; ++i) drawn.station(8.0 * i, 0);
    for (int i = 2; i >= 0; --i) drawn.station(8.0 * i + 4.0, apart_m);
    const auto east = drawn.station(30, 2, FP_STORAGE), west = drawn.station(-12, 2, FP_STORAGE);
    for (const std::uint32_t i : {0U, 1U, 3U, 4U}) drawn.segment(i, i + 1, false);
    drawn.segment(2, east, false), drawn.segment(east, 3, false);
    drawn.segment(5, west, false), drawn.segment(west, 0, false);
    drawn.segment(west, east);  // another way, so that no goal is cut off
    drawn.map();
  }
  DrawnMap drawn;
};

// An AGV on the other street could neither pass nor turn back. AGVs whose bodies pass each other may wait, even if
// there is no room to turn.
TEST(WaitingPlaces, AreNotWhereABodyBlocksAOneWayLane) {
  for (const auto& [apart_m, safe] : {std::pair(1.0, false), {1.3, true}, {4.0, true}}) {
    Streets streets(apart_m);
    const MapView map(streets.drawn.map());
    const TestFleet fleet(streets.drawn.map(), 2);
    HullGeometry geometry(map, fleet.briefing(0, 0));
    WaitingPlaces places(map, geometry);
    EXPECT_EQ(places.is_safe(1), safe) << apart_m;
    EXPECT_EQ(places.is_safe(4), safe) << apart_m;
  }
}

// From the dock in the west to the one in the east and back, each by its own street; `across` leads from the middle of
// the street back over the way there, right in front of station 1. An AGV there holds up those that cross, until it
// goes on.
TEST(WaitingPlaces, MayBeInFrontOfAOneWayCrossing) {
  DrawnMap drawn;
  for (int i = 0; i < 4; ++i) drawn.station(8.0 * i, 0);
  const auto north = drawn.station(9.3, 8), south = drawn.station(9.3, -8);
  const auto east = drawn.station(30, 8, FP_STORAGE), west = drawn.station(-12, 8, FP_STORAGE);
  for (std::uint32_t i = 0; i < 3; ++i) drawn.segment(i, i + 1, false);
  drawn.segment(3, east, false), drawn.segment(west, 0, false);
  drawn.segment(east, north, false), drawn.segment(north, west, false);
  const auto across = drawn.segment(north, south, false);
  drawn.segment(south, west, false);
  const MapView map(drawn.map());
  const TestFleet fleet(drawn.map(), 2);
  HullGeometry geometry(map, fleet.briefing(0, 0));
  bool blocks = false;
  for (const std::uint32_t lane : map.lanes_from(north))
    blocks = blocks || (map.lane(lane).segment == across && geometry.parts().standing_blocks_lane(1, {1.0, 0.0}, lane));
  EXPECT_TRUE(blocks);
  EXPECT_TRUE(WaitingPlaces(map, geometry).is_safe(1));
}

// Beside a place where an AGV stands there is no room to turn: if it wants to turn as well, both stay for ever.
TEST(CrampedPlaces, AreNoEndOfASection) {
  DrawnMap drawn;
  for (const double x_m : {0.0, 12.5, 16.0, 28.0}) drawn.station(x_m, 0);
  const auto east = drawn.station(28, -20), west = drawn.station(0, -20), beside = drawn.station(12.5, 1.95),
             north = drawn.station(12.5, 8);
  for (const auto& [from, to] :
       {std::pair(0U, 1U), {1, 2}, {2, 3}, {3, east}, {east, west}, {west, 0}, {beside, north}})
    drawn.segment(from, to);
  drawn.segment(north, 3);
  const MapView map(drawn.map());
  const TestFleet fleet(drawn.map(), 2);
  HullGeometry geometry(map, fleet.briefing(0, 0));
  Neighbours neighbours(map, geometry, fleet.briefing(0, 0));
  SectionPlanner planner(map, geometry, neighbours, 0);
  const std::vector<Goal> goals{{3, Leg::Kind::Pick}};
  const auto end = [&] { return end_of(map, planner.towards({}, {40.0, kPathLanesMax}, goals).path).station; };
  EXPECT_EQ(end(), 1U);
  Message message;
  message.status.stamp_ms = 1;
  message.status.held.station = beside;
  ASSERT_NE(neighbours.note(1, message, 0), Neighbours::News::Refused);
  EXPECT_EQ(end(), 2U);
}

class Planning : public ::testing::Test {
 protected:
  Section towards(std::uint32_t from, std::vector<Goal> goals, double budget_m = 40.0) {
    Path standing;
    standing.station = from;
    return planner.towards(standing, {budget_m, kPathLanesMax}, goals);
  }
  std::uint32_t end(const Section& s) { return end_of(map, s.path).station; }
  void put(std::uint32_t agv, std::uint32_t station) {
    Message m;
    m.status.stamp_ms = ++stamp;
    m.status.waiting = true;
    m.status.held.station = station;
    ASSERT_NE(neighbours.note(agv, m, 0), Neighbours::News::Refused);
  }

  Street street;
  MapView map{street.drawn.map()};
  TestFleet fleet{street.drawn.map(), 3};
  HullGeometry geometry{map, fleet.briefing(0, 0)};
  Neighbours neighbours{map, geometry, fleet.briefing(0, 0)};
  SectionPlanner planner{map, geometry, neighbours, 0};
  std::uint32_t stamp = 0;
};

TEST_F(Planning, SectionEndsAtAWaitingPlaceFarEnough) {
  const Section s = towards(0, {{5, Leg::Kind::Pick}});
  EXPECT_EQ(end(s), 3U);
  EXPECT_EQ(s.goals, 0U);
  EXPECT_EQ(s.legs.size(), 3U);
}

TEST_F(Planning, GoesOnFromAGoalWhereOneMustNotWait) {
  const Section s = towards(0, {{1, Leg::Kind::Pick}, {8, Leg::Kind::Drop}});
  EXPECT_EQ(end(s), 8U);
  EXPECT_EQ(s.goals, 2U);
  ASSERT_EQ(s.legs.size(), 4U);
  EXPECT_EQ(s.legs[1].kind, Leg::Kind::Pick);
  EXPECT_EQ(s.legs[3].kind, Leg::Kind::Drop);
}

TEST_F(Planning, AfterTheLastGoalItLeavesForAWaitingPlace) {
  const Section s = towards(0, {{2, Leg::Kind::Drop}});
  EXPECT_EQ(s.goals, 1U);
  EXPECT_TRUE(planner.places().is_safe(end(s)));
  EXPECT_EQ(s.legs.back().kind, Leg::Kind::Drive);
}

// It stays there until it is charged, whoever asks for the place: it must not hold a way on meanwhile.
TEST_F(Planning, EndsAtTheChargerEvenIfItIsNoWaitingPlace) {
  const Section s = towards(0, {{2, Leg::Kind::Charge}, {8, Leg::Kind::Drop}});
  EXPECT_FALSE(planner.places().is_safe(2));
  EXPECT_EQ(end(s), 2U);
  EXPECT_EQ(s.goals, 1U);
  EXPECT_EQ(s.legs.back().kind, Leg::Kind::Charge);
}

TEST_F(Planning, GoesRoundAWaitingAgv) {
  put(1, 3);
  const Section s = towards(0, {{5, Leg::Kind::Pick}});
  EXPECT_TRUE(end(s) == 6U || end(s) == 7U) << end(s);
}

TEST_F(Planning, StaysWithinTheBudget) {
  EXPECT_TRUE(towards(0, {{5, Leg::Kind::Pick}}, 3.0).empty());
  EXPECT_LE(length_m(map, towards(0, {{5, Leg::Kind::Pick}}, 8.5).path), 8.5);
}

TEST_F(Planning, GetsOutOfTheWayOfWhatIsHeld) {
  put(1, 8);
  put(2, 5);
  Path standing;
  standing.station = 3;
  for (const double draw : {0.0, 0.3, 0.6, 0.9}) {
    const Section s = planner.out_of_the_way(standing, {40.0, kPathLanesMax}, false, false, draw, {});
    ASSERT_FALSE(s.empty());
    EXPECT_TRUE(end(s) == 0U || end(s) == 6U || end(s) == 7U) << end(s);
  }
}

TEST_F(Planning, KeepsClearOfTheRequestsOfThoseThatGoFirst) {
  put(1, 8);
  Message m;
  m.kind = MessageKind::Request;
  m.status.stamp_ms = ++stamp;
  m.status.epoch = first_epoch(0) + 1;
  m.status.requesting = m.status.waiting = true;
  m.status.held.station = 5;
  m.request.station = 5;
  for (const auto& [from, to] : {std::pair(5U, 4U), {4U, 7U}, {7U, 6U}})
    m.request.append(street.drawn.lane_between(from, to));
  ASSERT_NE(neighbours.note(2, m, 0), Neighbours::News::Refused);
  Path standing;
  standing.station = 3;
  const Budget budget{40.0, kPathLanesMax};
  const auto goes_first = [](std::uint32_t agv, const Neighbour&) { return agv == 2; };
  for (const double draw : {0.0, 0.3, 0.6, 0.9}) {
    const std::uint32_t place = end(planner.out_of_the_way(standing, budget, false, false, draw, goes_first));
    EXPECT_LT(place, 3U) << "the others are requested or taken";
  }
}

}  // namespace
}  // namespace fleetproof::agents::waiting_places_test
