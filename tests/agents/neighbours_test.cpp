#include "core/agents/neighbours.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/agents/controller.hpp"
#include "tests/agents/drawn_map.hpp"

namespace fleetproof::agents::neighbours_test {
namespace {

class NeighboursTest : public ::testing::Test {
 protected:
  NeighboursTest() {
    here.station = 0;
    here.append(drawn.lane_between(0, 1));
  }

  // AGV 1 tells that it is at x, and that it has heard one's stamp of that instant; 0: none.
  bool state_from_1(double x_m, std::int64_t heard_sent_ns, std::int64_t now_ns, std::uint32_t stamp_ms) {
    Message m;
    m.status.stamp_ms = stamp_ms;
    m.status.position_m = {x_m, 0.0};
    m.status.held.station = 1;
    m.heard.count = 2;
    m.heard.stamps_ms[0] = heard_sent_ns < 0 ? 0 : stamp_ms_at(heard_sent_ns);
    return neighbours.note(1, m, now_ns) != Neighbours::News::Refused;
  }

  testing::DrawnMap drawn = [] {
    testing::DrawnMap d;
    d.segment(d.station(0, 0), d.station(4, 0));
    return d;
  }();
  testing::TestFleet fleet{drawn.map(), 2};
  MapView map{drawn.map()};
  HullGeometry geometry{map, fleet.briefing(0, 0)};
  Neighbours neighbours{map, geometry, fleet.briefing(0, 0)};
  Path here;
};

TEST_F(NeighboursTest, TheUnknownAndTheUnprovedAreNeverExcluded) {
  EXPECT_FALSE(neighbours.surely_beyond(1, here, 0));
  ASSERT_TRUE(state_from_1(500.0, -1, kSecond_ns, 1000));
  EXPECT_FALSE(neighbours.surely_beyond(1, here, kSecond_ns)) << "far, but that may be long ago";
}

TEST_F(NeighboursTest, AProvedPositionExcludesUntilItIsTooOld) {
  ASSERT_TRUE(state_from_1(100.0, 10 * kSecond_ns, 12 * kSecond_ns, 11'000));
  EXPECT_TRUE(neighbours.surely_beyond(1, here, 12 * kSecond_ns));
  EXPECT_TRUE(neighbours.surely_beyond(1, here, 30 * kSecond_ns));
  // 100 m away from a hull that reaches to 4.8 m; claims of 40 m; 2.2 m/s: gone after some 24 s.
  EXPECT_FALSE(neighbours.surely_beyond(1, here, 36 * kSecond_ns));
}

TEST_F(NeighboursTest, NearIsNeverExcluded) {
  ASSERT_TRUE(state_from_1(44.0, 10 * kSecond_ns, 10 * kSecond_ns, 10'000));
  EXPECT_FALSE(neighbours.surely_beyond(1, here, 10 * kSecond_ns));
}

TEST_F(NeighboursTest, AnOlderProofDoesNotReplaceANewerOne) {
  ASSERT_TRUE(state_from_1(10.0, 20 * kSecond_ns, 21 * kSecond_ns, 20'500));
  ASSERT_TRUE(state_from_1(200.0, 5 * kSecond_ns, 22 * kSecond_ns, 5'500));
  EXPECT_FALSE(neighbours.surely_beyond(1, here, 22 * kSecond_ns));
}

TEST_F(NeighboursTest, AcknowledgementsFromTheFutureAreNoProof) {
  ASSERT_TRUE(state_from_1(500.0, 50 * kSecond_ns, 10 * kSecond_ns, 10'000));
  EXPECT_FALSE(neighbours.surely_beyond(1, here, 10 * kSecond_ns));
}

TEST_F(NeighboursTest, ImpossiblePathsAreRefused) {
  Message m;
  m.status.held.station = 2;
  EXPECT_EQ(neighbours.note(1, m, 0), Neighbours::News::Refused);
  m.status.held.station = 1;
  m.status.held.append(drawn.lane_between(0, 1));
  EXPECT_EQ(neighbours.note(1, m, 0), Neighbours::News::Refused) << "a lane that does not begin there";
  m.status.held = here;
  EXPECT_NE(neighbours.note(1, m, 0), Neighbours::News::Refused);
  EXPECT_EQ(neighbours.note(0, m, 0), Neighbours::News::Refused) << "from oneself";
  EXPECT_EQ(neighbours.note(2, m, 0), Neighbours::News::Refused) << "from nobody of the fleet";
}

// A record takes 1.3 kB: in a large fleet, most AGVs never hear of each other.
TEST_F(NeighboursTest, ThereIsNoRecordOfAgvsThatAreNeverHeardOf) {
  const testing::TestFleet many(drawn.map(), 200);
  Neighbours n(map, geometry, many.briefing(0, 0));
  const Neighbours& seen = n;
  EXPECT_EQ(&seen.of(7), &seen.of(150)) << "all that are unknown share one record";
  EXPECT_FALSE(seen.of(7).known);
  Message m;
  m.tells_zones = true;
  m.status.stamp_ms = 10;
  m.status.held.station = 1;
  for (const std::uint32_t agv : {150U, 7U}) ASSERT_NE(n.note(agv, m, 0), Neighbours::News::Refused);
  const Neighbour& kept = seen.of(7);
  EXPECT_NE(&kept, &seen.of(150));
  EXPECT_EQ(&seen.of(8), &seen.of(149));
  for (std::uint32_t agv = 10; agv < 100; ++agv) ASSERT_NE(n.note(agv, m, 0), Neighbours::News::Refused);
  EXPECT_EQ(&kept, &seen.of(7)) << "a record stays where it is";
  std::vector<std::uint32_t> known;
  n.for_each_known([&](std::uint32_t agv, const Neighbour&) { known.push_back(agv); });
  ASSERT_EQ(known.size(), 92U);
  EXPECT_TRUE(std::ranges::is_sorted(known));
  EXPECT_EQ(known.front(), 7U);
}

TEST_F(NeighboursTest, ChangesGrowWithAllThatCountsForAWay) {
  Message m;
  m.status.held.station = 1;
  const auto grows = [&](std::uint32_t stamp_ms) {
    const std::uint64_t before = neighbours.changes();
    m.status.stamp_ms = stamp_ms;
    EXPECT_NE(neighbours.note(1, m, 0), Neighbours::News::Refused);
    m.repeats_way = true;
    return neighbours.changes() > before;
  };
  EXPECT_TRUE(grows(10)) << "it is heard for the first time";
  EXPECT_FALSE(grows(11)) << "it says the same";
  for (bool Condition::*const what : {&Condition::waiting, &Condition::idle, &Condition::out_of_order}) {
    m.status.*what = true;
    EXPECT_TRUE(grows(++m.status.stamp_ms));
    EXPECT_FALSE(grows(m.status.stamp_ms)) << "it says so twice";
  }
  m.status.waiting = false;
  EXPECT_FALSE(grows(5)) << "that was before";
  m.status.waiting = true;
  m.status.requesting = true;
  m.status.epoch = next_request(first_epoch(0));
  m.request.station = 1;
  m.request.append(drawn.lane_between(1, 0));
  EXPECT_TRUE(grows(20)) << "a request";
  EXPECT_FALSE(grows(21));
  m.status.requesting = false;
  EXPECT_TRUE(grows(22)) << "which is over";
  EXPECT_FALSE(grows(23));
  m.repeats_way = false;
  m.status.ahead.append(drawn.lane_between(1, 0));
  EXPECT_TRUE(grows(24)) << "it means to go on";
}

TEST_F(NeighboursTest, RequestsThatAreHistoryStayClosed) {
  Message m;
  m.kind = MessageKind::Request;
  m.status.stamp_ms = 10;
  m.status.epoch = 4;
  m.status.requesting = true;
  m.request = here;
  ASSERT_NE(neighbours.note(1, m, 0), Neighbours::News::Refused);
  EXPECT_TRUE(neighbours.of(1).request_is_open());
  Message over = m;
  over.kind = MessageKind::State;
  over.status.stamp_ms = 20;
  over.status.requesting = false;
  ASSERT_NE(neighbours.note(1, over, 0), Neighbours::News::Refused);
  EXPECT_FALSE(neighbours.of(1).request_is_open());
  ASSERT_NE(neighbours.note(1, m, 0), Neighbours::News::Refused);
  EXPECT_FALSE(neighbours.of(1).request_is_open()) << "a late duplicate";
}

// 100 m away; claims of 40 m; the hull reaches to 4.8 m: 54 m are left, of which late positions and errors take theirs.
TEST_F(NeighboursTest, LatePositionsAndFasterDrivesShortenTheProof) {
  const auto beyond = [&](double late_s, double error_m, double deviation, std::int64_t age_s) {
    fp_agv agv = testing::kTestAgv;
    agv.speed_deviation = deviation;
    const testing::TestFleet two(drawn.map(), 2, agv);
    Settings settings;
    settings.position_late_s = late_s;
    settings.position_error_m = error_m;
    Neighbours n(map, geometry, two.briefing(0, 0), settings);
    Message m;
    m.status.position_m = {100.0, 0.0};
    m.status.held.station = 1;
    m.heard.count = 1;
    m.heard.stamps_ms[0] = stamp_ms_at(0);
    EXPECT_NE(n.note(1, m, 0), Neighbours::News::Refused);
    return n.surely_beyond(1, here, age_s * kSecond_ns);
  };
  EXPECT_TRUE(beyond(0.0, 0.0, 0.0, 20));
  EXPECT_FALSE(beyond(10.0, 0.0, 0.0, 20)) << "22 m driven since that position";
  EXPECT_FALSE(beyond(0.0, 8.0, 0.0, 20));
  EXPECT_FALSE(beyond(0.0, 0.0, 0.3, 20));
}

TEST_F(NeighboursTest, ANewBootEndsWhatTheFormerOneAskedFor) {
  Message m;
  m.kind = MessageKind::Request;
  m.status.stamp_ms = 50;
  m.status.epoch = 4;
  m.status.requesting = true;
  m.request = here;
  ASSERT_NE(neighbours.note(1, m, 0), Neighbours::News::Refused);
  Message again;
  again.status.stamp_ms = 20;  // a clock that has been set back does not make it older
  again.status.epoch = first_epoch(1);
  again.status.waiting = true;
  ASSERT_NE(neighbours.note(1, again, 0), Neighbours::News::Refused);
  EXPECT_FALSE(neighbours.of(1).request_is_open());
  EXPECT_TRUE(neighbours.of(1).status.waiting);
  m.status.stamp_ms = 60;
  ASSERT_NE(neighbours.note(1, m, 0), Neighbours::News::Refused);
  EXPECT_FALSE(neighbours.of(1).request_is_open()) << "late, of the former boot";
  EXPECT_TRUE(neighbours.of(1).status.waiting);
  m.status.epoch = next_request(first_epoch(1));
  ASSERT_NE(neighbours.note(1, m, 0), Neighbours::News::Refused);
  EXPECT_TRUE(neighbours.of(1).request_is_open());
}

}  // namespace
}  // namespace fleetproof::agents::neighbours_test
