#include <gtest/gtest.h>

#include "campaign/batch/audit_share.hpp"

namespace fleetproof::audit_share_test {
namespace {

CampaignPlan plan_with(double share, std::vector<AgentFactor> agents = {"hull-lock", "reckless"}) {
  CampaignPlan plan;
  plan.agents = std::move(agents);
  plan.audit.share = share;
  return plan;
}

AuditShare share_of(const CampaignPlan& plan) { return {plan, AgentPrograms()}; }

RunRecord run(std::uint64_t index) {
  RunRecord record;
  record.run_index = index;
  return record;
}

TEST(AuditShare, HoldsOneDrawnRunOfEveryBlockAndTheFirstRunOfEachAgent) {
  const AuditShare share = share_of(plan_with(0.01));
  for (std::uint64_t agent = 0; agent < 2; ++agent) {
    EXPECT_TRUE(share.contains(run(agent)));
    for (std::uint64_t block = 1; block < 50; ++block) {
      int count = 0;
      for (std::uint64_t number = 100 * block; number < 100 * (block + 1); ++number)
        count += share.contains(run(2 * number + agent)) ? 1 : 0;
      EXPECT_EQ(count, 1) << "block " << block << " of agent " << agent;
    }
  }
}

TEST(AuditShare, DrawsItsRunsByTheSeedOfTheCampaign) {
  CampaignPlan other = plan_with(0.01);
  other.seed = 2;
  const AuditShare one = share_of(plan_with(0.01)), two = share_of(other);
  int apart = 0;
  for (std::uint64_t index = 200; index < 20'000; ++index)
    apart += one.contains(run(index)) != two.contains(run(index)) ? 1 : 0;
  EXPECT_GT(apart, 300);
}

TEST(AuditShare, HoldsNothingOrEverythingAtItsEnds) {
  const AuditShare none = share_of(plan_with(0.0)), all = share_of(plan_with(1.0));
  for (std::uint64_t index = 0; index < 100; ++index) {
    EXPECT_FALSE(none.contains(run(index)));
    EXPECT_TRUE(all.contains(run(index)));
  }
}

TEST(AuditShare, HoldsTheFirstRunsOfAPlugin) {
  AgentPrograms programs;
  const std::string name = programs.know(FLEETPROOF_UNSTEADY_AGENT);
  const AuditShare share(plan_with(0.001, {name, "reckless"}), programs);
  int of_reference_agent = 0;
  for (std::uint64_t number = 0; number < kAuditsToPass; ++number) {
    EXPECT_TRUE(share.contains(run(2 * number))) << number;
    of_reference_agent += share.contains(run(2 * number + 1)) ? 1 : 0;
  }
  EXPECT_LE(of_reference_agent, 2) << "its first run, and perhaps the drawn one";
}

TEST(AuditShare, HoldsNoRunThatHung) {
  RunRecord hung = run(0);
  hung.outcome.hang = true;
  EXPECT_FALSE(share_of(plan_with(1.0)).contains(hung));
}

}  // namespace
}  // namespace fleetproof::audit_share_test
