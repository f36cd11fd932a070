#include <gtest/gtest.h>

#include "tests/agents/crossing.hpp"

namespace fleetproof::agents {
namespace {

using RepeatedGrants = testing::Crossing;

// A radio that fails in one direction at a time: the REQUEST arrives, and much later a GRANT does.
TEST_F(RepeatedGrants, AreSentWhileTheRequestIsOpen) {
  fleet_of(2);
  members[1]->protocol->repeat_grants();
  EXPECT_TRUE(sent.empty()) << "nothing has been granted";
  want(0, 3, 0);
  EXPECT_FALSE(settle(0));
  ASSERT_TRUE(deliver(MessageKind::Request, 0, 1));
  sent.clear();  // the first GRANT is lost
  members[1]->protocol->repeat_grants();
  ASSERT_TRUE(deliver(MessageKind::Grant, 1, 0));
  EXPECT_TRUE(settle(0));
}

TEST_F(RepeatedGrants, EndWithTheRequest) {
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
  members[1]->protocol->repeat_grants();
  EXPECT_TRUE(sent.empty());
}

}  // namespace
}  // namespace fleetproof::agents
