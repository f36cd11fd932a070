#include "core/agents/lock_claim.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/agents/crossing.hpp"

namespace fleetproof::agents::lock_claim_test {
namespace {

Path way(std::uint32_t station, const std::vector<std::uint32_t>& lanes) {
  Path path;
  path.station = station;
  for (const std::uint32_t lane : lanes) path.append(lane);
  return path;
}

TEST(AnnouncedWayStamps, LanesWithWhichTheFormerWayBeganKeepTheirs) {
  AnnouncedWay announced;
  announced.replace(way(7, {1, 2, 3}), 100);
  announced.replace(way(7, {1, 2, 4, 5}), 200);
  EXPECT_EQ(announced.since_ms(0), 0U);
  EXPECT_EQ(announced.since_ms(2), 100U);
  EXPECT_EQ(announced.since_ms(3), 200U);
  announced.replace(way(7, {1}), 300);
  announced.replace(way(7, {1, 2, 4, 5}), 400);
  EXPECT_EQ(announced.since_ms(1), 100U);
  EXPECT_EQ(announced.since_ms(2), 400U) << "it was not announced in between";
  announced.replace(way(8, {1, 2}), 500);
  EXPECT_EQ(announced.since_ms(1), 500U) << "from another station";
}

TEST(AnnouncedWayStamps, MoveUpWhenLanesAreHeld) {
  testing::DrawnMap drawn;
  for (int i = 0; i < 4; ++i) drawn.station(5.0 * i, 0);
  for (std::uint32_t i = 0; i < 3; ++i) drawn.segment(i, i + 1);
  const MapView map(drawn.map());
  const std::uint32_t first = drawn.lane_between(0, 1), second = drawn.lane_between(1, 2);
  const std::uint32_t third = drawn.lane_between(2, 3);
  AnnouncedWay announced;
  announced.replace(way(0, {first, second}), 100);
  announced.replace(way(0, {first, second, third}), 200);
  announced.shorten(map, 1);
  EXPECT_TRUE(announced.path() == way(1, {second, third}));
  EXPECT_EQ(announced.since_ms(1), 100U);
  EXPECT_EQ(announced.since_ms(2), 200U);
}

// AGV 0 at station 1, AGV 1 at station 2, and so on, around station 0.
class AnnouncedWays : public testing::Crossing {
 protected:
  void SetUp() override { now_ns = kSecond_ns; }

  std::uint32_t lane(std::uint32_t from, std::uint32_t to) { return drawn.lane_between(from, to); }
  // Requests the lanes, and announces the others. The demand of AGV 0 is the youngest.
  void request(std::uint32_t id, const std::vector<std::uint32_t>& lanes, const std::vector<std::uint32_t>& onward) {
    LockProtocol& protocol = *members[id]->protocol;
    Path path = end_of(*map, protocol.held());
    for (const std::uint32_t l : lanes) path.append(l);
    ASSERT_TRUE(protocol.request(path, 10 - id, onward));
  }
  // Nothing else is in the air afterwards.
  void tell(std::uint32_t from, std::uint32_t to) {
    sent.clear();
    now_ns += 2 * kSecond_ns;
    members[from]->protocol->repeat();
    for (const Sent& s : sent) {
      if (s.to == to && s.message.kind == MessageKind::State) told = s.message;
    }
    ASSERT_TRUE(deliver(MessageKind::State, from, to));
    sent.clear();
  }

  Message told;  // the last STATE that was told
};

TEST_F(AnnouncedWays, NeedNoConsentOfAnAgvThatHeardOfThemAndKeepsClear) {
  fleet_of(2);
  request(0, {lane(1, 0)}, {lane(0, 3)});
  EXPECT_FALSE(settle(0)) << "nothing is known of 1";
  ASSERT_TRUE(deliver(MessageKind::Request, 0, 1));
  ASSERT_TRUE(deliver(MessageKind::Grant, 1, 0));
  ASSERT_TRUE(settle(0));
  request(0, {lane(0, 3)}, {});
  sent.clear();
  EXPECT_TRUE(settle(0)) << "the GRANT acknowledged the REQUEST, and that announced this lane";
  EXPECT_TRUE(sent.empty());
}

TEST_F(AnnouncedWays, NeedConsentUntilTheyAreAcknowledged) {
  fleet_of(2);
  request(0, {lane(1, 0)}, {});
  settle(0);
  ASSERT_TRUE(deliver(MessageKind::Request, 0, 1));
  ASSERT_TRUE(deliver(MessageKind::Grant, 1, 0));
  ASSERT_TRUE(settle(0));
  tell(1, 0);
  now_ns += kSecond_ns;
  request(0, {lane(0, 3)}, {});
  EXPECT_FALSE(settle(0)) << "1 may count on the way that ended at 0";
  tell(1, 0);
  EXPECT_FALSE(settle(0)) << "a message of 1 that acknowledges what was sent before";
  tell(0, 1);
  tell(1, 0);
  EXPECT_TRUE(settle(0));
}

TEST_F(AnnouncedWays, NeedConsentOfAnAgvWhoseOwnWayIsNear) {
  fleet_of(2);
  request(1, {lane(2, 0)}, {lane(0, 3)});
  settle(1);
  ASSERT_TRUE(deliver(MessageKind::Request, 1, 0));
  request(0, {lane(1, 0)}, {});
  settle(0);
  ASSERT_TRUE(deliver(MessageKind::Request, 0, 1));
  ASSERT_TRUE(deliver(MessageKind::Defer, 1, 0));
  EXPECT_FALSE(settle(0));
  members[1]->protocol->withdraw();
  tell(1, 0);
  EXPECT_FALSE(settle(0)) << "it still announces that way";
}

// AGV 1 knows of the request of AGV 0, and is not asked: so it says nothing. If it granted the request all the same,
// and later asks for the same floor, so that AGV 0 lets it pass, then the early GRANT is over.
TEST_F(AnnouncedWays, AGrantWithoutAQuestionIsNotSentAndEndsWithItsEpoch) {
  fleet_of(3);
  for (std::uint32_t id : {1U, 2U}) {
    tell(0, id);
    tell(id, 0);
  }
  request(0, {lane(1, 0)}, {});  // asks both: they have not heard of it
  settle(0);
  now_ns += 2 * kSecond_ns;
  members[0]->protocol->repeat();
  ASSERT_TRUE(deliver(MessageKind::State, 0, 1));
  tell(1, 0);
  settle(0);
  request(0, {lane(1, 0)}, {});  // another epoch, of which AGV 1 has heard: it is not asked
  sent.clear();
  EXPECT_FALSE(settle(0));
  EXPECT_FALSE(is_asked(1));
  members[0]->protocol->repeat();
  ASSERT_TRUE(deliver(MessageKind::State, 0, 1));
  sent.clear();
  members[1]->protocol->withdraw();  // everything is looked at again
  settle(1);
  EXPECT_FALSE(deliver(MessageKind::Grant, 1, 0)) << "without being asked";
  tell(1, 0);
  Message early = told;
  early.kind = MessageKind::Grant;
  early.echo = members[0]->protocol->epoch();
  request(1, {lane(2, 0)}, {});  // its demand is older
  settle(1);
  ASSERT_TRUE(deliver(MessageKind::Request, 1, 0));
  ASSERT_TRUE(deliver(MessageKind::Grant, 0, 1));
  sent.clear();
  settle(0);
  members[0]->protocol->repeat();
  EXPECT_TRUE(is_asked(1));
  ASSERT_TRUE(deliver(MessageKind::State, 0, 1) || deliver(MessageKind::Request, 0, 1));
  EXPECT_TRUE(deliver(MessageKind::Defer, 1, 0));
  EXPECT_FALSE(deliver(MessageKind::Grant, 1, 0));
  members[0]->protocol->receive(1, WireMessage(early).bytes());
  members[0]->protocol->receive(2, WireMessage(early).bytes());
  EXPECT_FALSE(settle(0)) << "1 granted what is over";
}

// The newest message that a restarted AGV knows may be one that was on its way since before the restart.
TEST_F(AnnouncedWays, OfMessagesThatMayBeOlderThanTheRestartDoNotCount) {
  fleet_of(2);
  tell(1, 0);
  now_ns += kSecond_ns;
  restart(0, 1);
  members[0]->neighbours->restarted_at(now_ns);
  request(0, {lane(1, 0)}, {});
  settle(0);
  const auto is_apart = [&](Epoch request) {
    return members[0]->neighbours->is_apart(1, members[0]->protocol->requested(), request);
  };
  tell(1, 0);
  EXPECT_FALSE(is_apart(1)) << "1 has heard nothing of the new self";
  tell(0, 1);
  tell(1, 0);
  EXPECT_TRUE(is_apart(2));
}

}  // namespace
}  // namespace fleetproof::agents::lock_claim_test
