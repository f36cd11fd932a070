#include "campaign/batch/audit_counts.hpp"

#include <gtest/gtest.h>

namespace fleetproof::audit_counts_test {
namespace {

constexpr std::size_t kPlugin = 0, kSecondPlugin = 1, kReferenceAgent = 2, kAgents = 3;

// Two agents of one plug-in, and a reference agent.
class AuditCountsOfAgents : public testing::Test {
 protected:
  AuditCounts counts(double share) const {
    CampaignPlan plan;
    plan.agents = {"unsteady", "unsteady", "reckless"};
    plan.agents[kSecondPlugin].name = "second";
    plan.audit.share = share;
    return {plan, programs_};
  }
  // Audits of the agent's first runs, which came out the same or not.
  static void audit(AuditCounts& counts, std::size_t agent, int count, bool same) {
    for (std::uint64_t number = 0; number < static_cast<std::uint64_t>(count); ++number)
      counts.add({{kAgents * number + agent, 0}, same});
  }
  void SetUp() override { ASSERT_EQ(programs_.know(FLEETPROOF_UNSTEADY_AGENT), "unsteady"); }

  AgentPrograms programs_;
};

TEST_F(AuditCountsOfAgents, NeedRecordingsUntilTwentyAuditsCameOutTheSame) {
  AuditCounts counts = this->counts(0.01);
  EXPECT_TRUE(counts.needs_recordings(kPlugin));
  audit(counts, kPlugin, 19, true);
  EXPECT_TRUE(counts.needs_recordings(kPlugin));
  audit(counts, kPlugin, 1, true);
  EXPECT_FALSE(counts.needs_recordings(kPlugin));
  audit(counts, kPlugin, 100, true);
  EXPECT_FALSE(counts.needs_recordings(kPlugin));
}

TEST_F(AuditCountsOfAgents, NeedRecordingsForEverAfterOneAuditThatDiffered) {
  AuditCounts early = counts(0.01), late = counts(0.01);
  audit(early, kPlugin, 1, false);
  audit(early, kPlugin, 1000, true);
  EXPECT_TRUE(early.needs_recordings(kPlugin));
  audit(late, kPlugin, 1000, true);
  audit(late, kPlugin, 1, false);
  EXPECT_TRUE(late.needs_recordings(kPlugin)) << "although it had passed";
  audit(late, kPlugin, 1000, true);
  EXPECT_TRUE(late.needs_recordings(kPlugin));
}

TEST_F(AuditCountsOfAgents, CountEachAgentForItself) {
  AuditCounts counts = this->counts(0.01);
  ASSERT_EQ(counts.agent_count(), kAgents);
  audit(counts, kPlugin, 20, true);
  EXPECT_FALSE(counts.needs_recordings(kPlugin));
  EXPECT_TRUE(counts.needs_recordings(kSecondPlugin)) << "other parameters may make it another agent";
  audit(counts, kSecondPlugin, 20, true);
  audit(counts, kSecondPlugin, 1, false);
  EXPECT_FALSE(counts.needs_recordings(kPlugin));
  EXPECT_TRUE(counts.needs_recordings(kSecondPlugin));
}

TEST_F(AuditCountsOfAgents, NeverNeedRecordingsOfAReferenceAgent) {
  AuditCounts counts = this->counts(0.01);
  EXPECT_FALSE(counts.needs_recordings(kReferenceAgent));
  audit(counts, kReferenceAgent, 1, false);
  EXPECT_FALSE(counts.needs_recordings(kReferenceAgent)) << "its runs are simulated again, and show the engine's error";
}

TEST_F(AuditCountsOfAgents, NeedNoRecordingsWithoutAudits) {
  const AuditCounts counts = this->counts(0.0);
  for (std::size_t agent = 0; agent < kAgents; ++agent) EXPECT_FALSE(counts.needs_recordings(agent)) << agent;
}

}  // namespace
}  // namespace fleetproof::audit_counts_test
