#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "campaign/run/replay.hpp"

namespace fleetproof {
namespace {

TEST(ReplaySuspects, AreSaidByTheAgentsOwnPromise) {
  AgentProgram agent;
  agent.flags = FP_DETERMINISTIC;
  EXPECT_THAT(std::string(suspects_of(agent)), testing::HasSubstr("the engine or the agent is at fault"));
  agent.flags = 0;
  EXPECT_THAT(std::string(suspects_of(agent)), testing::HasSubstr("does not declare"));
}

}  // namespace
}  // namespace fleetproof
