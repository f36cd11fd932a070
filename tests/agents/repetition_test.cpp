#include <gtest/gtest.h>

#include "tests/agents/crossing.hpp"

namespace fleetproof::agents::repetition_test {
namespace {

using Repetition = testing::Crossing;

TEST_F(Repetition, RepairsALostRequest) {
  fleet_of(2);
  want(0, 3, 0);
  EXPECT_FALSE(settle(0));
  sent.clear();
  members[0]->protocol->repeat();
  ASSERT_TRUE(deliver(MessageKind::State, 0, 1));
  ASSERT_TRUE(deliver(MessageKind::Grant, 1, 0));
  EXPECT_TRUE(settle(0));
}

// A radio that fails in one direction at a time: the REQUEST arrives, and much later a GRANT does.
TEST_F(Repetition, RepairsALostGrantWhileTheRequestIsOpen) {
  fleet_of(2);
  want(0, 3, 0);
  EXPECT_FALSE(settle(0));
  ASSERT_TRUE(deliver(MessageKind::Request, 0, 1));
  sent.clear();  // the first GRANT is lost
  members[1]->protocol->repeat();
  ASSERT_TRUE(deliver(MessageKind::State, 1, 0)) << "which repeats it";
  EXPECT_TRUE(settle(0));
}

// One addressee in a large fleet gets a message of its own.
TEST_F(Repetition, GoesToFewAddresseesAlone) {
  fleet_of(4);
  want(0, 1, 0);
  EXPECT_FALSE(settle(0));
  for (std::uint32_t agv = 1; agv < 4; ++agv) ASSERT_TRUE(deliver(MessageKind::Request, 0, agv));
  for (std::uint32_t agv = 1; agv < 3; ++agv) ASSERT_TRUE(deliver(MessageKind::Grant, agv, 0) || agv == 1);
  members[0]->protocol->repeat();  // with its STATE
  members[3]->protocol->repeat();
  sent.clear();
  members[3]->protocol->repeat();
  EXPECT_EQ(sent.size(), 1U);
  EXPECT_TRUE(deliver(MessageKind::Grant, 3, 0));
}

TEST_F(Repetition, EndsWithTheRequest) {
  fleet_of(2);
  want(0, 3, 0);
  settle(0);
  ASSERT_TRUE(deliver(MessageKind::Request, 0, 1, true));
  ASSERT_TRUE(deliver(MessageKind::Grant, 1, 0));
  EXPECT_TRUE(settle(0));
  want(1, 2, 0);
  settle(1);
  ASSERT_TRUE(deliver(MessageKind::Request, 1, 0));
  ASSERT_TRUE(deliver(MessageKind::Defer, 0, 1)) << "with the news that the request of 0 is over";
  sent.clear();
  members[1]->protocol->repeat();
  ASSERT_FALSE(sent.empty());
  EXPECT_EQ(sent.front().message.answers.count, 0U);
}

// It stands in every STATE, but is no reason to send one.
TEST_F(Repetition, SendsNothingForTheSakeOfADeferThatIsKnown) {
  fleet_of(2);
  want(0, 2, 0);  // to where 1 stands
  settle(0);
  ASSERT_TRUE(deliver(MessageKind::Request, 0, 1));
  members[0]->protocol->repeat();
  sent.clear();  // the DEFER is lost
  members[1]->protocol->repeat();
  ASSERT_EQ(sent.front().message.answers.count, 1U);
  EXPECT_FALSE(sent.front().message.answers.list[0].granted);
  ASSERT_TRUE(deliver(MessageKind::State, 1, 0));
  now_ns += 2 * kSecond_ns;
  members[0]->protocol->repeat();
  ASSERT_TRUE(deliver(MessageKind::State, 0, 1)) << "it has deferred, says the STATE";
  members[1]->protocol->repeat();
  ASSERT_EQ(sent.size(), 1U) << "after two seconds";
  EXPECT_EQ(sent.front().message.answers.count, 1U);
  sent.clear();
  for (int i = 0; i < 6; ++i) members[1]->protocol->repeat();
  EXPECT_TRUE(sent.empty());
}

}  // namespace
}  // namespace fleetproof::agents::repetition_test
