#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "campaign/run/replay.hpp"

namespace fleetproof::trusted_agents_test {
namespace {

TEST(ReplaySuspects, TheEngineOnlyIfTheAgentPromisesAndTheAuditsBearItOut) {
  AgentProgram agent;
  EXPECT_TRUE(is_trusted(agent, {})) << "a reference agent";
  agent.file = "own.so";
  EXPECT_FALSE(is_trusted(agent, {20, 0})) << "promises nothing";
  agent.flags = FP_DETERMINISTIC;
  EXPECT_TRUE(is_trusted(agent, {20, 0}));
  EXPECT_FALSE(is_trusted(agent, {19, 0})) << "too few audits";
  EXPECT_FALSE(is_trusted(agent, {30, 1}));
  EXPECT_FALSE(is_trusted(agent, {0, 0})) << "no audit";
}

}  // namespace
}  // namespace fleetproof::trusted_agents_test
