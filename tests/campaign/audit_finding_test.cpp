// What a worker says of a run may be damaged; what its agents did is played where no plug-in can damage anything.
#include "campaign/batch/audit_finding.hpp"

#include <gtest/gtest.h>

#include "campaign/workers/isolated_runs.hpp"
#include "core/base/error.hpp"
#include "storage/checksum.hpp"
#include "tests/contract/campaigns/small_campaign.hpp"

namespace fleetproof::audit_finding_test {
namespace {

class AuditFindings : public testing::Test {
 protected:
  AuditFindings() {
    plan.agents = {"untidy"};
    plan.horizon_s = 120.0;
    plan.replicates = 20;
    plan.gates.clear();
    programs.know(FLEETPROOF_UNTIDY_AGENT);
  }

  // The first run of the software in which it breaks the distance, with a recording.
  RunRecord violating_run() {
    Hosting hosting;
    hosting.audits = true;
    IsolatedRuns runs(plan, programs, hosting);
    for (std::uint64_t index = 0; index < plan.run_count(); ++index) {
      RunRecord record = runs(index, true);
      if (!record.outcome.violations.empty()) return record;
    }
    throw EngineError("the software breaks the distance now and then");
  }

  CampaignPlan plan = test::small_plan();
  AgentPrograms programs;
  RunOne run_one{plan, programs};
};

TEST_F(AuditFindings, ARunThatComesOutTheSameIsTheSame) {
  const RunRecord run = violating_run();
  ASSERT_FALSE(run.recording.empty());
  const AuditedRun found = audit_finding(run_one, run, row_checksum(run));
  EXPECT_TRUE(found.same);
  EXPECT_EQ(found.audit.checksum, row_checksum(run));
}

// The worker of the campaign has forgotten the violation.
TEST_F(AuditFindings, DamageToTheWorkerOfTheCampaignIsFound) {
  const RunRecord run = violating_run();
  RunRecord stored = run;
  stored.outcome.violations.clear();
  const AuditedRun found = audit_finding(run_one, run, row_checksum(stored));
  EXPECT_FALSE(found.same);
  EXPECT_EQ(found.audit.checksum, row_checksum(run));
}

// Both workers have forgotten it: their words agree, and the tape tells.
TEST_F(AuditFindings, DamageToBothWorkersIsFound) {
  RunRecord damaged = violating_run();
  const RunRecord run = damaged;
  damaged.outcome.violations.clear();
  damaged.outcome.digest ^= 1;
  const AuditedRun found = audit_finding(run_one, damaged, row_checksum(damaged));
  EXPECT_FALSE(found.same);
  ASSERT_TRUE(found.audit.outcome.has_value());
  EXPECT_EQ(*found.audit.outcome, audited_outcome(run));
}

// Damage to the worker of the audit alone is no difference of the software.
TEST_F(AuditFindings, DamageToTheWorkerOfTheAuditIsNone) {
  RunRecord damaged = violating_run();
  const std::uint64_t checksum = row_checksum(damaged);
  damaged.outcome.violations.clear();
  EXPECT_TRUE(audit_finding(run_one, damaged, checksum).same);
}

TEST_F(AuditFindings, ATapeThatBreaksOffIsADifference) {
  RunRecord run = violating_run();
  const std::uint64_t checksum = row_checksum(run);
  run.recording.resize(run.recording.size() / 2);
  const AuditedRun found = audit_finding(run_one, run, checksum);
  EXPECT_FALSE(found.same);
  EXPECT_FALSE(found.audit.outcome.has_value());
}

}  // namespace
}  // namespace fleetproof::audit_finding_test
