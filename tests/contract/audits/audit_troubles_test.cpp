// What ends audits before their time. The campaign beside them goes on to its verdict, and says why they ended.
#include <gmock/gmock.h>

#include "storage/archive_reader.hpp"
#include "tests/contract/audits/audited_campaign.hpp"

namespace fleetproof::audit_troubles_test {
namespace {

using test::failing;
using testing::HasSubstr;

class AuditTroubles : public test::AuditedCampaign {
 protected:
  static std::vector<Outcome> outcomes(const std::string& archive) {
    std::vector<Outcome> list;
    ArchiveReader(archive).for_each_run([&](const RunRecord& run) { list.push_back(run.outcome); });
    return list;
  }
  // Starts the campaign in the background, with a gate that agents may wait for.
  static std::string started(const std::string& words) {
    return "export FLEETPROOF_TEST_GATE=gate\n\"$FLEETPROOF\" " + words + " & program=$!\n";
  }
  // Waits until this command succeeds, or the program has ended.
  static std::string until(const std::string& command) {
    return "while kill -0 $program && ! " + command + "; do sleep 0.02; done\n";
  }
};

TEST_F(AuditTroubles, APluginThatIsRebuiltMeanwhile) {
  write_campaign(failing("burn 1") + ", \"hull-lock\"", 30, 0.5, "[limits]\ncpu_s = 100\n");
  write("gate", "open");
  const auto undisturbed = run("run c.toml --db one.db");
  std::filesystem::remove(path("gate"));
  const auto finished = shell(started("run c.toml --db c.db -j 1") + until("grep -q gate c.worker-0.log") +
                              "cp failing.so rebuilt.so; echo >>rebuilt.so; mv rebuilt.so failing.so\n"
                              "touch gate; wait $program");
  EXPECT_EQ(finished.exit_code, undisturbed.exit_code) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr("the audits ended early: "));
  EXPECT_THAT(finished.err, HasSubstr("failing.so: this file was changed while the campaign ran; begin again with the "
                                      "new one, or put the old one back; the runs themselves are not affected\n"));
  EXPECT_EQ(outcomes(path("c.db")).size(), 60U);
  EXPECT_EQ(outcomes(path("c.db")), outcomes(path("one.db")));
  EXPECT_EQ(audits("c.db").at("failing").at("audited"), 0);
  EXPECT_GE(audits("one.db").at("failing").at("audited"), 20) << "the test is about something";
}

// The first runs of a shard are simulated before all others, in workers of their own.
TEST_F(AuditTroubles, APluginThatIsRebuiltBetweenTwoWorkersIsNoFaultOfTheEngine) {
  write_campaign(failing("burn 1"), 4, 0.0, "[limits]\ncpu_s = 100\n");
  const auto finished = shell(started("run c.toml --shard 1/1 --out part -j 1") + until("[ -e part/plan.db ]") +
                              "cp failing.so rebuilt.so; echo >>rebuilt.so; mv rebuilt.so failing.so\n"
                              "touch gate; wait $program");
  EXPECT_EQ(finished.exit_code, 3);
  // It may have said what it is going to do before.
  EXPECT_THAT(finished.err, testing::ContainsRegex("(^|\n)error: [^\n]*failing\\.so: this file was changed"));
  EXPECT_THAT(finished.err, HasSubstr("failing.so: this file was changed while the campaign ran; begin again with the "
                                      "new one, or put the old one back\n"));
}

// Then nobody knows whether that software does the same again.
TEST_F(AuditTroubles, AShardThatCouldNotAuditLeavesTheClaimOpen) {
  const std::string gate =
      "[coverage]\nprobes = []\n[[gate]]\nname = \"g\"\nagent = \"failing\"\nlimit = 0.9\n"
      "min_transports_per_agv_hour = 0.5\n";
  write_campaign(failing("audit-burn 1"), 100, 1.0, "[limits]\ncpu_s = 100\n" + gate);
  write("gate", "open");
  ASSERT_EQ(run("run c.toml --shard 1/1 --out whole").exit_code, 0);
  EXPECT_EQ(run("merge whole --db whole.db").exit_code, 0);
  // The first runs of a shard are simulated twice before all others, and do not wait.
  const auto shard =
      shell(started("run c.toml --shard 1/1 --out part -j 1 2>talk.txt") + until("[ -e part/canary.txt ]") +
            "rm gate\n" + until("{ kill -USR1 $program; grep -q 'audits to do' talk.txt; }") +
            "cp failing.so rebuilt.so; echo >>rebuilt.so; mv rebuilt.so failing.so\n"
            "touch gate; wait $program");
  EXPECT_THAT(read(path("talk.txt")), HasSubstr("the audits ended early: "));
  const auto merged = run("merge part --db part.db");
  EXPECT_EQ(merged.exit_code, 4) << merged.err;
  EXPECT_THAT(merged.out, testing::ContainsRegex("[0-9]+ audits are due, and were not done"));
  EXPECT_EQ(outcomes(path("part.db")), outcomes(path("whole.db")));
}

TEST_F(AuditTroubles, RunsThatHangInAnAuditOnly) {
  write_campaign(failing("audit-loop 1"), 30, 1.0, "[limits]\ncpu_s = 0.1\n");
  const auto finished = run("run c.toml --db c.db -j 1");
  EXPECT_EQ(finished.exit_code, 4);
  EXPECT_THAT(finished.err, HasSubstr("the audits ended early: 3 runs hang in an audit and did not before; the runs "
                                      "themselves are not affected\n"));
  const auto found = audits("c.db").at("failing");
  EXPECT_EQ(found.at("audited"), 3);
  EXPECT_EQ(found.at("differing"), 3);
  write_campaign(failing("none 1"), 30, 0.0);
  ASSERT_EQ(run("run c.toml --db one.db").exit_code, 4);
  EXPECT_EQ(outcomes(path("c.db")).size(), 30U);
  EXPECT_EQ(outcomes(path("c.db")), outcomes(path("one.db")));
}

TEST_F(AuditTroubles, AnInterruptLeavesThemToTheNextSession) {
  write_campaign(failing("audit-burn 1"), 30, 1.0, "[limits]\ncpu_s = 100\n");
  write("gate", "open");
  ASSERT_EQ(run("run c.toml --db one.db").exit_code, 4);
  std::filesystem::remove(path("gate"));
  const auto interrupted = shell(started("run c.toml --db c.db -j 1 2>talk.txt") + until("grep -q workers talk.txt") +
                                 until("{ kill -USR1 $program; grep -q '30 audits to do' talk.txt; }") +
                                 "kill -INT $program; wait $program");
  EXPECT_EQ(interrupted.exit_code, 130);
  EXPECT_THAT(read(path("talk.txt")), HasSubstr("30 of its runs are still to be audited; go on: fleetproof run c.toml "
                                                "--db c.db\n"));
  EXPECT_EQ(outcomes(path("c.db")), outcomes(path("one.db"))) << "all runs are stored";
  EXPECT_EQ(audits("c.db").at("failing").at("audited"), 0);
  EXPECT_GT(audits("c.db").at("failing").at("recordings"), 0) << "it has not passed";
  write("gate", "open");
  ASSERT_EQ(run("run c.toml --db c.db").exit_code, 4);
  EXPECT_EQ(audits("c.db").at("failing").at("audited"), 30);
  EXPECT_TRUE(read(path("c.db")) == read(path("one.db")));
}

}  // namespace
}  // namespace fleetproof::audit_troubles_test
