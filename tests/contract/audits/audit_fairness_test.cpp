// An audit blames nobody for a difference that has another reason: another engine, or a limit for plug-ins.
#include <gmock/gmock.h>

#include "campaign/batch/campaign.hpp"
#include "campaign/batch/stored_plan.hpp"
#include "campaign/plan/campaign_file.hpp"
#include "campaign/run/run_one.hpp"
#include "storage/archive_reader.hpp"
#include "storage/archive_writer.hpp"
#include "tests/contract/audits/audited_campaign.hpp"

namespace fleetproof::audit_fairness_test {
namespace {

using testing::HasSubstr;
using testing::Not;

class AuditFairness : public test::AuditedCampaign {
 protected:
  // The campaign as another engine leaves it, by which the runs come out otherwise: this test is another program than
  // fleetproof. It has audited nothing.
  void write_archive_of_another_engine(std::uint64_t replicates) const {
    CampaignPlan plan = read_campaign_file(path("c.toml")).plan;
    plan.replicates = replicates;
    const AgentPrograms programs;
    const RunOne run_one(plan, programs);
    ArchiveWriter archive(path("c.db"), stored_plan(plan, programs));
    for (std::uint64_t index = 0; index < plan.run_count(); ++index) {
      RunRecord record = run_one(index);
      record.outcome.digest ^= 1;
      archive.add(record);
    }
    archive.publish(plan.run_count());
  }
  std::vector<std::uint64_t> audited_runs() const {
    std::vector<std::uint64_t> runs;
    ArchiveReader(path("c.db")).for_each_audit([&](const AuditRecord& audit, bool) {
      runs.push_back(audit.run_index);
    });
    return runs;
  }
};

TEST_F(AuditFairness, RunsOfAnotherEngineAreNotAudited) {
  write_campaign("\"hull-lock\", \"reckless\"", 20, 1.0);
  write_archive_of_another_engine(10);
  const auto refused = run("run c.toml --db c.db");
  ASSERT_EQ(refused.exit_code, 2);
  ASSERT_THAT(refused.err, HasSubstr("program sha256: stored "));
  const auto drifted = run("run c.toml --db c.db --allow-drift");
  EXPECT_EQ(drifted.exit_code, 4) << drifted.err;
  EXPECT_EQ(audited_runs().size(), 20U);
  EXPECT_EQ(audited_runs().front(), 20U) << "the first run of this engine";
  // The third session cannot tell whose runs these are.
  const auto grown = run("run c.toml --db c.db --replicates 25");
  EXPECT_EQ(grown.exit_code, 4) << grown.err;
  EXPECT_EQ(audited_runs().size(), 30U);
  for (const auto& [agent, audit] : audits("c.db")) EXPECT_EQ(audit.at("differing"), 0) << agent;
  EXPECT_THAT(run("report c.db").out, Not(HasSubstr("engine error")));
}

// Reference agents run in the main process, without limits. Here one needs more than the plug-ins may have.
TEST_F(AuditFairness, ReferenceAgentsAndTheProgramItselfHaveNoLimitOfMemory) {
  write("c.toml",
        "name = \"c\"\nreplicates = 2\nhorizon_s = 600\ndefault_gates = false\n[factors]\n"
        "agents = [\"hull-lock\", { file = \"still.so\", name = \"still\" }]\nlayouts = [\"aisle-grid\"]\n"
        "fleet_sizes = [20]\nloss = [0.4]\ndelay_s = [2]\n[limits]\nmemory_mb = 1\n[audit]\nshare = 1\n");
  std::filesystem::copy_file(FLEETPROOF_NAMED_AGENT, path("still.so"));
  const auto finished = shell("FLEETPROOF_TEST_AGENT=standing \"$FLEETPROOF\" run c.toml --db c.db -j 2");
  EXPECT_EQ(finished.exit_code, 4) << finished.out << finished.err;
  for (const auto& [agent, audit] : audits("c.db")) {
    EXPECT_EQ(audit.at("audited"), 2) << agent;
    EXPECT_EQ(audit.at("differing"), 0) << agent;
  }
}

}  // namespace
}  // namespace fleetproof::audit_fairness_test
