// Audits: a share of the runs is simulated once more in another process. Software that is not deterministic is noticed,
// and its failed runs are replayed from their recordings.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "campaign/plan/plan_text.hpp"
#include "campaign/run/replay.hpp"
#include "storage/archive_reader.hpp"
#include "tests/contract/audits/audited_campaign.hpp"

namespace fleetproof::audit_test {
namespace {

using test::failing;
using test::unsteady;
using testing::HasSubstr;

class Audits : public test::AuditedCampaign {};

TEST_F(Audits, SoftwareThatIsNotDeterministicIsNoticedAndMeasured) {
  std::vector<std::string> kinds = {"addresses", "static"};
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // sanitizers fill heap and stack themselves
  kinds.insert(kinds.end(), {"heap", "stack"});
#endif
  std::string agents = unsteady("steady");
  for (const std::string& kind : kinds) agents += ", " + unsteady(kind);
  write_campaign(agents, 300, 0.1);
  ASSERT_EQ(run("run c.toml --db c.db").exit_code, 4) << "a plug-in of this kind is no fault of the engine";
  const auto found = audits("c.db");
  for (const std::string& agent : kinds) {
    EXPECT_GE(found.at(agent).at("audited"), 30) << agent;
    EXPECT_GT(found.at(agent).at("differing"), 0) << agent;
    EXPECT_GT(found.at(agent).at("failed_runs"), 0) << agent;
    EXPECT_EQ(found.at(agent).at("recordings"), found.at(agent).at("failed_runs")) << agent;
  }
  EXPECT_EQ(found.at("static").at("depends_on_earlier_runs"), true);
  EXPECT_EQ(found.at("addresses").at("depends_on_earlier_runs"), false);
  EXPECT_EQ(found.at("steady").at("depends_on_earlier_runs"), false);
  EXPECT_EQ(found.at("steady").at("differing"), 0);
  EXPECT_EQ(found.at("steady").at("recordings"), 0) << "its runs are replayed from their seeds";
  const std::string page = run("report c.db").out;
  EXPECT_THAT(page, HasSubstr("agent addresses: this software is not deterministic in "));
  EXPECT_THAT(page, HasSubstr("runs were audited, and every one came out the same."));
}

// A run of this kind comes out as it did if it follows the same run. Were the order that of the campaign, only the
// first run of each process would differ: eight of 60.
TEST_F(Audits, HappenInAnotherOrderOfRuns) {
  write_campaign(unsteady("before"), 60, 1.0);
  ASSERT_EQ(run("run c.toml --db c.db -j 1").exit_code, 4);
  const auto found = audits("c.db");
  EXPECT_EQ(found.at("before").at("audited"), 60);
  EXPECT_GT(found.at("before").at("differing"), 30);
  EXPECT_EQ(found.at("before").at("depends_on_earlier_runs"), true);
}

TEST_F(Audits, HaveOtherAddressesEvenIfThoseOfTheCampaignAreFixed) {
  if (shell("setarch -R true").exit_code != 0) GTEST_SKIP() << "addresses cannot be fixed here";
  write_campaign(unsteady("place"), 20, 1.0);
  ASSERT_EQ(shell("setarch -R \"$FLEETPROOF\" run c.toml --db c.db").exit_code, 4);
  const auto found = audits("c.db");
  EXPECT_EQ(found.at("place").at("audited"), 20);
  EXPECT_EQ(found.at("place").at("differing"), 20);
}

TEST_F(Audits, EveryFailedRunIsReplayedFromItsRecordingWithoutTheSoftware) {
  write_campaign(unsteady("addresses") + ", " + unsteady("static"), 100, 0.1);
  ASSERT_EQ(run("run c.toml --db c.db").exit_code, 4);
  std::filesystem::remove(path("unsteady.so"));
  std::filesystem::remove(path("c.sessions.jsonl"));
  const ArchiveReader archive(path("c.db"));
  const CampaignPlan plan = parse_plan(archive.campaign().plan_json);
  std::uint64_t replayed = 0, first = 0;
  archive.for_each_run([&](const RunRecord& run) {
    if (!run.outcome.is_failure()) return;
    const auto result = replay_recording(archive, plan, run.run_index);
    ASSERT_TRUE(result.has_value()) << run.run_index;
    EXPECT_EQ(result->verdict, ReplayVerdict::Reproduced) << run.run_index << ": " << result->explanation;
    EXPECT_EQ(result->recomputed.outcome, run.outcome);
    if (replayed++ == 0) first = run.run_index;
  });
  EXPECT_GT(replayed, 20U);
  const auto told = run(fmt::format("replay c.db {}", first));
  EXPECT_EQ(told.exit_code, 0) << told.err;
  EXPECT_THAT(told.out, HasSubstr("from the recording of what its agents did"));
  EXPECT_THAT(run(fmt::format("replay c.db {} --trace", first)).err,
              testing::AllOf(HasSubstr("AGV 0"), HasSubstr("state          unsteady")))
      << "a trace needs no software, and it has the notes that were made in a worker process";
}

TEST_F(Audits, TheSoftwareItselfMayEndOtherwiseAndIsNotCalledAFaultOfTheEngine) {
  write_campaign(unsteady("static"), 40, 0.5);
  ASSERT_EQ(run("run c.toml --db c.db").exit_code, 4);
  int other = 0;
  for (int index = 1; index < 12; ++index) {
    const auto replayed = run(fmt::format("replay c.db {} --plugin unsteady.so", index));
    EXPECT_THAT(replayed.exit_code, testing::AnyOf(0, 4)) << replayed.out << replayed.err;
    if (replayed.exit_code != 4) continue;
    ++other;
    EXPECT_THAT(replayed.out, HasSubstr("NOT DETERMINISTIC"));
    EXPECT_THAT(replayed.out, HasSubstr("audited runs of this agent came out differently, too"));
  }
  EXPECT_GT(other, 0);
  const auto verified = run("verify c.db --sample 100%");
  EXPECT_EQ(verified.exit_code, 4) << verified.out << verified.err;
}

TEST_F(Audits, OfSteadySoftwareLeaveOneFile) {
  write_campaign("\"hull-lock\", \"reckless\", " + failing("mixed 4"), 60, 0.2);
  ASSERT_EQ(run("run c.toml --db one.db -j 1").exit_code, 4);
  ASSERT_EQ(run("run c.toml --db many.db -j 5").exit_code, 4);
  EXPECT_TRUE(read(path("one.db")) == read(path("many.db")));
  ASSERT_EQ(run("run c.toml --db grown.db --replicates 7").exit_code, 4);
  ASSERT_EQ(run("run c.toml --db grown.db").exit_code, 4);
  EXPECT_TRUE(read(path("one.db")) == read(path("grown.db"))) << "the audits of both sessions are those of one";
  const auto found = audits("one.db");
  for (const auto& [agent, audit] : found) {
    EXPECT_GE(audit.at("audited"), 12) << agent;
    EXPECT_EQ(audit.at("differing"), 0) << agent;
    EXPECT_EQ(audit.at("recordings"), 0) << agent;
  }
  EXPECT_GT(found.at("failing").at("failed_runs"), 0);
}

TEST_F(Audits, WithoutAShareNothingIsAuditedAndNothingRecorded) {
  write_campaign(unsteady("steady") + ", \"reckless\"", 20, 0.0);
  ASSERT_EQ(run("run c.toml --db c.db").exit_code, 4);
  const auto found = audits("c.db");
  EXPECT_EQ(found.at("steady").at("audited"), 0);
  EXPECT_GT(found.at("steady").at("failed_runs"), 0);
  EXPECT_EQ(found.at("steady").at("recordings"), 0);
  EXPECT_THAT(run("report c.db").out, HasSubstr("Agent steady: no run was audited."));
}

}  // namespace
}  // namespace fleetproof::audit_test
