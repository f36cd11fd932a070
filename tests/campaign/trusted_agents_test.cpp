#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "campaign/run/replay.hpp"

namespace fleetproof::trusted_agents_test {
namespace {

TEST(ReplaySuspects, TheEngineOnlyIfTheAgentPromisesAndTheAuditsBearItOut) {
  EXPECT_TRUE(is_trusted(false, false, {})) << "a reference agent";
  EXPECT_FALSE(is_trusted(true, false, {20, 0})) << "promises nothing";
  EXPECT_TRUE(is_trusted(true, true, {20, 0}));
  EXPECT_FALSE(is_trusted(true, true, {19, 0})) << "too few audits";
  EXPECT_FALSE(is_trusted(true, true, {30, 1}));
  EXPECT_FALSE(is_trusted(true, true, {0, 0})) << "no audit";
}

}  // namespace
}  // namespace fleetproof::trusted_agents_test
