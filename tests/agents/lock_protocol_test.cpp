#include "core/agents/lock_protocol.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <memory>
#include <random>

#include "tests/agents/crossing.hpp"

namespace fleetproof::agents::lock_protocol_test {
namespace {

using LockProtocolTest = testing::Crossing;

TEST_F(LockProtocolTest, AloneItLocksAtOnce) {
  fleet_of(1);
  want(0, 3, 0);
  EXPECT_TRUE(settle(0));
  EXPECT_EQ(members[0]->protocol->held().count, 2U);
}

// What an AGV holds contains its body only as long as the held path is one way that begins where the AGV is.
TEST_F(LockProtocolTest, OnlyAContinuationOfTheHeldPathIsRequested) {
  fleet_of(1);
  LockProtocol& protocol = *members[0]->protocol;
  want(0, 3, 0);
  ASSERT_TRUE(settle(0));  // it holds 1 > 0 > 3, and stands at 1
  const std::uint32_t first = drawn.lane_between(1, 0), second = drawn.lane_between(0, 3);
  EXPECT_TRUE(protocol.may_drive(first));
  EXPECT_FALSE(protocol.may_drive(second));
  const auto request = [&](std::uint32_t from, std::vector<std::uint32_t> lanes) {
    Path path;
    path.station = from;
    for (const std::uint32_t lane : lanes) path.append(lane);
    const bool requested = protocol.request(path, 0);
    EXPECT_EQ(protocol.requesting(), requested);
    return settle(0);
  };
  EXPECT_FALSE(request(1, {first})) << "from where the AGV stands";
  EXPECT_FALSE(request(3, {first})) << "a lane from elsewhere";
  EXPECT_TRUE(request(3, {drawn.lane_between(3, 0)}));
  EXPECT_FALSE(request(0, {second, drawn.lane_between(3, 0), second, drawn.lane_between(3, 0)})) << "42 m";
}

TEST_F(LockProtocolTest, EverybodyMustGrant) {
  fleet_of(3);
  want(0, 4, 0);
  EXPECT_FALSE(settle(0));
  ASSERT_TRUE(deliver(MessageKind::Request, 0, 1));
  ASSERT_TRUE(deliver(MessageKind::Grant, 1, 0));
  EXPECT_FALSE(settle(0));
  ASSERT_TRUE(deliver(MessageKind::Request, 0, 2));
  ASSERT_TRUE(deliver(MessageKind::Grant, 2, 0, true));
  ASSERT_TRUE(deliver(MessageKind::Grant, 2, 0));
  EXPECT_TRUE(settle(0));
}

TEST_F(LockProtocolTest, ManyGrantsOfOneMemberAreOne) {
  fleet_of(3);
  want(0, 4, 0);
  settle(0);
  ASSERT_TRUE(deliver(MessageKind::Request, 0, 1));
  for (int i = 0; i < 5; ++i) deliver(MessageKind::Grant, 1, 0, true);
  EXPECT_FALSE(settle(0));
}

TEST_F(LockProtocolTest, AGrantCountsForItsEpochOnly) {
  fleet_of(2);
  want(0, 3, 0);
  settle(0);
  ASSERT_TRUE(deliver(MessageKind::Request, 0, 1));
  want(0, 4, 0);  // another epoch
  settle(0);
  ASSERT_TRUE(deliver(MessageKind::Grant, 1, 0));
  EXPECT_FALSE(settle(0));
  ASSERT_TRUE(deliver(MessageKind::Request, 0, 1));
  ASSERT_TRUE(deliver(MessageKind::Grant, 1, 0));
  EXPECT_TRUE(settle(0));
}

TEST_F(LockProtocolTest, WhoHoldsDefersAndGrantsOnHisOwnWhenHeHasPassed) {
  fleet_of(2);
  want(0, 3, 0);
  settle(0);
  deliver(MessageKind::Request, 0, 1);
  deliver(MessageKind::Grant, 1, 0);
  ASSERT_TRUE(settle(0));
  want(1, 4, 5);
  settle(1);
  ASSERT_TRUE(deliver(MessageKind::Request, 1, 0));
  EXPECT_TRUE(deliver(MessageKind::Defer, 0, 1));
  members[0]->protocol->lane_passed();
  settle(0);
  EXPECT_FALSE(deliver(MessageKind::Grant, 0, 1)) << "it still has the crossing to leave";
  members[0]->protocol->lane_passed();
  settle(0);
  EXPECT_TRUE(deliver(MessageKind::Grant, 0, 1));
  EXPECT_TRUE(settle(1));
}

// Rule 2 of the protocol, in the case that taking back only what one holds gets wrong: the grant is still in the air.
TEST_F(LockProtocolTest, WhoLetsAnElderPassStepsBackEvenFromGrantsInFlight) {
  fleet_of(2);
  want(0, 3, 100);
  settle(0);
  ASSERT_TRUE(deliver(MessageKind::Request, 0, 1));  // 1 wants nothing yet and grants; the grant stays in the air
  want(1, 4, 50);                                    // the elder demand
  settle(1);
  ASSERT_TRUE(deliver(MessageKind::Request, 1, 0));
  ASSERT_TRUE(deliver(MessageKind::Grant, 0, 1));
  EXPECT_TRUE(settle(1));
  ASSERT_TRUE(deliver(MessageKind::Grant, 1, 0)) << "the old one";
  EXPECT_FALSE(settle(0));
}

// Every pair of AGVs has its own epochs: the consent of the others is not lost.
TEST_F(LockProtocolTest, WhoStepsBackAsksOnlyThatAgvAgain) {
  fleet_of(3);
  want(0, 4, 100);
  settle(0);
  ASSERT_TRUE(deliver(MessageKind::Request, 0, 2));
  ASSERT_TRUE(deliver(MessageKind::Grant, 2, 0));
  want(1, 4, 50);  // the elder demand
  settle(1);
  ASSERT_TRUE(deliver(MessageKind::Request, 1, 0));
  ASSERT_TRUE(deliver(MessageKind::Grant, 0, 1));
  sent.clear();
  members[0]->protocol->repeat();
  EXPECT_TRUE(is_asked(1));
  EXPECT_FALSE(is_asked(2));
  ASSERT_TRUE(deliver(MessageKind::State, 0, 1));
  EXPECT_TRUE(deliver(MessageKind::Defer, 1, 0)) << "1 wants it, too, and comes first";
  members[1]->protocol->withdraw();
  settle(1);
  ASSERT_TRUE(deliver(MessageKind::Grant, 1, 0));
  EXPECT_TRUE(settle(0)) << "with the old grant of 2";
}

TEST_F(LockProtocolTest, AnEpochOfMoreAttemptsThanItHasNumbersBeginsAnew) {
  fleet_of(2);
  want(0, 3, 100);
  settle(0);
  for (int i = 0; i < 300; ++i) {
    sent.clear();
    want(1, 4, 50);
    settle(1);
    ASSERT_TRUE(deliver(MessageKind::Request, 1, 0)) << i;
    ASSERT_TRUE(deliver(MessageKind::Grant, 0, 1)) << i;
    members[1]->protocol->withdraw();
    settle(0);
  }
  EXPECT_GT(members[0]->protocol->epoch(), next_request(first_epoch(0)));
  sent.clear();
  members[0]->protocol->repeat();
  ASSERT_TRUE(deliver(MessageKind::State, 0, 1));
  ASSERT_TRUE(deliver(MessageKind::Grant, 1, 0));
  EXPECT_TRUE(settle(0));
}

TEST_F(LockProtocolTest, DuplicateOfAGrantedRequestIsGrantedAgainWithoutSteppingBack) {
  fleet_of(2);
  want(1, 4, 50);
  settle(1);
  ASSERT_TRUE(deliver(MessageKind::Request, 1, 0, true));
  want(0, 3, 100);
  settle(0);
  const Epoch epoch = members[0]->protocol->epoch();
  ASSERT_TRUE(deliver(MessageKind::Request, 1, 0));
  EXPECT_EQ(members[0]->protocol->epoch(), epoch);
  // Nor does it do harm: 1 is asked by that epoch and defers as long as it may use the grant.
  ASSERT_TRUE(deliver(MessageKind::Request, 0, 1));
  EXPECT_TRUE(deliver(MessageKind::Defer, 1, 0));
  EXPECT_FALSE(settle(0));
}

TEST_F(LockProtocolTest, OfTwoWhoWantTheSameTheElderGoesFirst) {
  for (const bool elder_first : {true, false}) {
    members.clear();
    sent.clear();
    fleet_of(2);
    want(0, 3, elder_first ? 1 : 9);
    want(1, 4, 5);
    settle(0), settle(1);
    ASSERT_TRUE(deliver(MessageKind::Request, 0, 1));
    ASSERT_TRUE(deliver(MessageKind::Request, 1, 0));
    const std::uint32_t winner = elder_first ? 0 : 1;
    EXPECT_TRUE(deliver(MessageKind::Grant, 1 - winner, winner));
    EXPECT_TRUE(settle(winner));
    EXPECT_FALSE(settle(1 - winner));
  }
}

TEST_F(LockProtocolTest, OfTwoEquallyOldDemandsExactlyOneGoesFirst) {
  fleet_of(2);
  want(0, 3, 5);
  want(1, 4, 5);
  settle(0), settle(1);
  ASSERT_TRUE(deliver(MessageKind::Request, 0, 1));
  ASSERT_TRUE(deliver(MessageKind::Request, 1, 0));
  EXPECT_TRUE(deliver(MessageKind::Grant, 1, 0));
  EXPECT_TRUE(deliver(MessageKind::Defer, 0, 1));
  EXPECT_TRUE(settle(0));
}

// The elder cannot move before the other has left: the request of the elder must not hold the other up.
TEST_F(LockProtocolTest, WhoIsBlockedByAWaitingAgvLetsItPass) {
  fleet_of(2);
  want(0, 2, 1);  // to where 1 stands
  want(1, 3, 9);
  settle(0), settle(1);
  ASSERT_TRUE(deliver(MessageKind::Request, 0, 1));
  ASSERT_TRUE(deliver(MessageKind::Request, 1, 0));
  EXPECT_TRUE(deliver(MessageKind::Grant, 0, 1));
  EXPECT_TRUE(settle(1));
}

// The elder waits for floor that an AGV holds which does not wait: meanwhile, the younger may pass. Not for ever.
TEST_F(LockProtocolTest, WhoIsHeldUpLetsOthersPassForAWhile) {
  for (const std::int64_t later_ns : {std::int64_t{0}, Blocker::kPatience_ns}) {
    members.clear(), sent.clear();
    fleet_of(3);
    members[2]->protocol->describe(false, false, false);
    members[2]->protocol->repeat();
    ASSERT_TRUE(deliver(MessageKind::State, 2, 0));
    want(0, 3, 1);  // to where 2 is
    settle(0);
    now_ns += later_ns;
    members[0]->protocol->repeat();
    want(1, 4, 9);
    settle(1);
    ASSERT_TRUE(deliver(MessageKind::Request, 1, 0));
    EXPECT_EQ(deliver(MessageKind::Grant, 0, 1), later_ns == 0);
    EXPECT_EQ(deliver(MessageKind::Defer, 0, 1), later_ns > 0);
  }
}

TEST_F(LockProtocolTest, SilenceIsNeverConsent) {
  fleet_of(2);
  want(0, 3, 0);
  int asked = 0;
  for (int i = 0; i < 1000; ++i) {
    EXPECT_FALSE(settle(0));
    sent.clear();
    members[0]->protocol->repeat();
    asked += is_asked(1) ? 1 : 0;
    now_ns += kSecond_ns / 2;
  }
  EXPECT_GT(asked, 200) << "but it goes on asking";
  EXPECT_LT(asked, 600) << "but not every time";
}

TEST_F(LockProtocolTest, TheFaultTakesSilenceForConsent) {
  fleet_of(2, {.consent = {.silence_consents_after_ns = 3 * kSecond_ns}});
  want(0, 3, 0);
  settle(0);
  now_ns = 3 * kSecond_ns - 1;
  EXPECT_FALSE(settle(0));
  now_ns = 3 * kSecond_ns;
  EXPECT_TRUE(settle(0));
}

// The grant of the former self is in the air when the new self asks for the same floor: the other gives up its request,
// and with it that grant.
TEST_F(LockProtocolTest, AGrantOfTheFormerSelfIsNeverCombinedWithALockOfTheNewOne) {
  fleet_of(2);
  want(0, 3, 100);
  settle(0);
  ASSERT_TRUE(deliver(MessageKind::Request, 0, 1));  // 1 grants; the grant stays in the air
  restart(1, 1);
  want(1, 4, 50);  // the elder demand
  EXPECT_FALSE(settle(1));
  ASSERT_TRUE(deliver(MessageKind::Request, 1, 0));
  ASSERT_TRUE(deliver(MessageKind::Grant, 0, 1));
  EXPECT_TRUE(settle(1));
  ASSERT_TRUE(deliver(MessageKind::Grant, 1, 0)) << "the former self's";
  EXPECT_FALSE(settle(0));
}

TEST_F(LockProtocolTest, WhoUsesAGrantOfTheFormerSelfDefersTheNewOne) {
  fleet_of(2);
  want(0, 3, 100);
  settle(0);
  ASSERT_TRUE(deliver(MessageKind::Request, 0, 1));
  restart(1, 1);
  want(1, 4, 50);
  settle(1);
  ASSERT_TRUE(deliver(MessageKind::Grant, 1, 0));
  EXPECT_TRUE(settle(0));
  ASSERT_TRUE(deliver(MessageKind::Request, 1, 0));
  EXPECT_TRUE(deliver(MessageKind::Defer, 0, 1));
  EXPECT_FALSE(settle(1));
}

TEST_F(LockProtocolTest, AGrantForARequestOfTheFormerSelfIsNoAnswerToTheNewOne) {
  fleet_of(2);
  want(0, 3, 0);
  settle(0);
  ASSERT_TRUE(deliver(MessageKind::Request, 0, 1));  // granted: number 1 of boot 0
  restart(0, 1);
  want(0, 4, 0);  // number 1 of boot 1
  settle(0);
  ASSERT_TRUE(deliver(MessageKind::Grant, 1, 0));
  EXPECT_FALSE(settle(0));
  ASSERT_TRUE(deliver(MessageKind::Request, 0, 1));
  ASSERT_TRUE(deliver(MessageKind::Grant, 1, 0));
  EXPECT_TRUE(settle(0));
}

TEST_F(LockProtocolTest, WhoDoesNotKnowItsPlaceGrantsNothingUntilItDoes) {
  fleet_of(2);
  restart(1, 1);
  members[1]->protocol->know_own_place(false);
  want(0, 3, 0);
  settle(0);
  ASSERT_TRUE(deliver(MessageKind::Request, 0, 1));
  EXPECT_TRUE(deliver(MessageKind::Defer, 1, 0));
  EXPECT_FALSE(settle(1));
  EXPECT_FALSE(deliver(MessageKind::Grant, 1, 0));
  members[1]->protocol->know_own_place(true);
  settle(1);
  EXPECT_TRUE(deliver(MessageKind::Grant, 1, 0));
  EXPECT_TRUE(settle(0));
}

TEST_F(LockProtocolTest, TheEndOfADriveThatNobodyHoldsChangesNothing) {
  fleet_of(1);
  members[0]->protocol->lane_passed();
  EXPECT_EQ(members[0]->protocol->held().station, 1U);
  EXPECT_EQ(members[0]->protocol->held().count, 0U);
}

// Bytes of former boots, of boots that never were, doubled, mixed up and damaged: none leads out of bounds, and what is
// held stays a way on the map.
TEST_F(LockProtocolTest, NoBytesFromAnybodyLeadOutOfBounds) {
  std::mt19937_64 draws(11);
  fleet_of(3);
  std::vector<std::vector<std::byte>> heard;
  for (int round = 0; round < 20'000; ++round) {
    const auto id = static_cast<std::uint32_t>(draws() % 3);
    if (draws() % 50 == 0) restart(id, static_cast<std::uint32_t>(round));
    if (!members[id]->protocol->requesting() && members[id]->protocol->held().empty())
      want(id, static_cast<std::uint32_t>(1 + draws() % 4), round);
    settle(id);
    if (!sent.empty()) heard.push_back(sent.front().bytes), sent.pop_front();
    if (heard.size() > 50) heard.erase(heard.begin() + static_cast<std::ptrdiff_t>(draws() % heard.size()));
    if (heard.empty()) continue;
    std::vector<std::byte> bytes = heard[draws() % heard.size()];
    for (std::uint64_t flips = draws() % 4; flips > 0; --flips)
      bytes[draws() % bytes.size()] = static_cast<std::byte>(draws());
    if (draws() % 10 == 0) bytes.resize(draws() % 64);
    members[id]->protocol->receive(static_cast<std::uint32_t>(draws() % 5), bytes);
    if (draws() % 8 == 0) members[id]->protocol->lane_passed();
    members[id]->protocol->repeat();
    now_ns += kSecond_ns / 10;
    ASSERT_TRUE(is_driveable(*map, members[id]->protocol->held()));
  }
}

TEST_F(LockProtocolTest, GarbageChangesNothing) {
  fleet_of(2);
  want(0, 3, 0);
  settle(0);
  const std::vector<std::byte> bytes(40, std::byte{0x5a});
  EXPECT_FALSE(members[0]->protocol->receive(1, bytes));
  EXPECT_FALSE(members[0]->protocol->receive(1, {}));
  EXPECT_FALSE(settle(0));
}

}  // namespace
}  // namespace fleetproof::agents::lock_protocol_test
