#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "campaign/run/replay.hpp"
#include "core/agents/agents.h"

namespace fleetproof {
namespace {

TEST(ReplaySuspects, AreSaidByTheAgentsOwnPromise) {
  fp_agent_type agent = *fp_reference_agents[0];
  agent.flags = FP_DETERMINISTIC;
  EXPECT_THAT(std::string(suspects_of(agent)), testing::HasSubstr("the engine or the agent is at fault"));
  agent.flags = 0;
  EXPECT_THAT(std::string(suspects_of(agent)), testing::HasSubstr("does not declare"));
}

}  // namespace
}  // namespace fleetproof
