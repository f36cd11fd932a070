// Campaigns that look green and are not, through the command line: worlds that repeat one world, audits that differ,
// the order of cells, software without a gate, ledgers with other names, comparisons under other conditions.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "tests/contract/audits/audited_campaign.hpp"

namespace fleetproof::verdict_tricks_test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class VerdictTricks : public test::AuditedCampaign {
 protected:
  // 60 worlds of "reckless", which breaks the distance in more than half of them. World 3 is clean.
  static std::string reckless(const std::string& vary, const std::string& gate = "limit = 0.2",
                              const std::string& losses = "0.0, 0.4") {
    return fmt::format(
        "replicates = 60\nhorizon_s = 120\n[factors]\nagents = [\"reckless\"]\nlayouts = [\"aisle-grid\"]\n"
        "fleet_sizes = [3]\nloss = [{}]\ndelay_s = [2]\n[world]\ntransports_per_agv_hour = 60\n[coverage]\nprobes = "
        "[]\n[vary]\n{}\n[[gate]]\nname = \"g\"\nagent = \"reckless\"\nmin_transports_per_agv_hour = 0.5\n{}\n",
        losses, vary, gate);
  }
  static constexpr const char* kOneWorld =
      "hold = [\"layout\", \"placement\", \"transports\", \"motion\", \"radio\", \"agent\"]\nheld_replicate = 3";

  json gate_of(const std::string& archive) const {
    return json::parse(run("report " + archive + " --format json --exit-zero").out).at("gates").at(0);
  }
};

TEST_F(VerdictTricks, RecklessSoftwareBreaksTheDistance) {
  write("c.toml", reckless("hold = []"));
  EXPECT_EQ(run("run c.toml --db c.db").exit_code, 1);
}

TEST_F(VerdictTricks, OneCleanWorldSixtyTimesIsOneWorld) {
  write("c.toml", reckless(kOneWorld));
  const auto finished = run("run c.toml --db c.db");
  EXPECT_EQ(finished.exit_code, 4);
  EXPECT_THAT(finished.out, HasSubstr("in 0 of 60 worlds, 1 distinct"));
  EXPECT_THAT(run("report c.db --exit-zero").out, HasSubstr("2 of 2 cells always have the same run"));
  EXPECT_EQ(gate_of("c.db").at("distinct_worlds"), 1);
}

TEST_F(VerdictTricks, OneCleanWorldIsOneInEveryUnitAndWithEveryMethod) {
  for (const char* gate : {"limit = 0.2\nunit = \"run\"", "limit = 0.2\nmethod = \"fixed\"",
                           "limit = 5\nunit = \"agv-hour\"", "limit = 0.2\nend_point = \"contact\""}) {
    write("c.toml", reckless(kOneWorld, gate));
    EXPECT_EQ(run("run c.toml --db c.db --overwrite").exit_code, 4) << gate;
  }
}

TEST_F(VerdictTricks, OneCleanWorldStaysOneInAFoldedFileAndWhenTheCampaignGoesOn) {
  write("c.toml", reckless(kOneWorld));
  EXPECT_EQ(run("run c.toml --db folded.db --keep failing").exit_code, 4);
  EXPECT_EQ(gate_of("folded.db").at("distinct_worlds"), 1);
  EXPECT_EQ(run("run c.toml --db c.db --until-verdict").exit_code, 4) << "60 equal worlds are no verdict";
  EXPECT_EQ(run("run c.toml --db c.db --until-verdict --replicates 120").exit_code, 4) << "nor are 120";
  EXPECT_EQ(gate_of("c.db").at("worlds"), 120);
  EXPECT_EQ(gate_of("c.db").at("distinct_worlds"), 1);
}

// Without losses, the radio that is left to vary changes nothing: that cell has one run.
TEST_F(VerdictTricks, ACellInWhichNothingVariesIsNamed) {
  std::string text =
      reckless("hold = [\"layout\", \"placement\", \"transports\", \"motion\", \"agent\"]\nheld_replicate = 3");
  for (auto at = text.find("reckless"); at != std::string::npos; at = text.find("reckless"))
    text.replace(at, 8, "hull-lock");
  write("c.toml", text);
  (void)run("run c.toml --db c.db");
  const json report = json::parse(run("report c.db --format json --exit-zero").out);
  EXPECT_THAT(
      report.at("weak_points").dump(),
      HasSubstr("1 of 2 cells always have the same run, so that there is no rate: hull-lock on aisle-grid, fleet "
                "of 3, 0 %, 2 s"));
  EXPECT_GT(report.at("gates").at(0).at("distinct_worlds"), 50);
}

TEST_F(VerdictTricks, TheOrderOfCellsChangesNoRatePerHour) {
  const auto upper = [&](const std::string& losses) {
    write("c.toml", reckless("hold = []", "limit = 100\nunit = \"agv-hour\"", losses));
    (void)run("run c.toml --db c.db --overwrite");
    return gate_of("c.db").at("claim").dump();
  };
  const std::string one = upper("0.0, 0.2, 0.4");
  EXPECT_EQ(upper("0.4, 0.0, 0.2"), one);
  EXPECT_EQ(upper("0.2, 0.4, 0.0"), one);
}

const std::string kPlain =
    "replicates = 60\nhorizon_s = 60\n[factors]\nagents = [{}]\nlayouts = [\"aisle-grid\"]\nfleet_sizes = [3]\n"
    "loss = [0.0]\ndelay_s = [0.1]\n[coverage]\nprobes = []\n[audit]\nshare = {}\n[[gate]]\nname = \"g\"\n"
    "agent = \"{}\"\nlimit = {}\nmin_transports_per_agv_hour = 0\nend_point = \"{}\"\n";

// What its thinking costs depends on addresses. Half of its worlds fail, and the gate bears that.
TEST_F(VerdictTricks, SoftwareThatIsJudgedOtherwiseTheSecondTimeIsNeverDemonstrated) {
  for (int time = 0; time < 3; ++time) {
    write("c.toml", fmt::format(fmt::runtime(kPlain), test::unsteady("addresses"), 1.0, "addresses", 0.8, "violation"));
    const auto finished = run("run c.toml --db c.db --overwrite");
    const json report = json::parse(run("report c.db --format json --exit-zero").out);
    const json& audit = report.at("audits").at(0);
    ASSERT_EQ(audit.at("audited"), 60);
    ASSERT_GT(audit.at("differing"), 0);
    EXPECT_EQ(report.at("verdict") == "demonstrated", audit.at("judged_otherwise") == 0) << finished.out;
  }
}

TEST_F(VerdictTricks, UntilVerdictWaitsForTheAuditsOfItsRuns) {
  write("c.toml", fmt::format(fmt::runtime(kPlain), test::unsteady("steady"), 0.5, "steady", 0.8, "violation"));
  const auto finished = run("run c.toml --db c.db --until-verdict");
  EXPECT_EQ(finished.exit_code, 0) << finished.out << finished.err;
  const json report = json::parse(run("report c.db --format json").out);
  EXPECT_LT(report.at("campaign").at("complete_replicates"), 60) << "it ended before the end";
  EXPECT_EQ(report.at("audits").at(0).at("audited"), report.at("campaign").at("complete_replicates"))
      << "the first 20 runs are all audited";
  EXPECT_EQ(report.at("audits").at(0).at("open"), 0);
}

TEST_F(VerdictTricks, SoftwareUnderTestWithoutAGateLeavesNothingDemonstrated) {
  const std::string ours = "{ name = \"ours\", agent = \"hull-lock\", role = \"candidate\" }",
                    theirs = "{ name = \"theirs\", agent = \"reckless\", role = \"candidate\" }";
  write("c.toml", fmt::format(fmt::runtime(kPlain), ours, 0.01, "ours", 0.2, "violation"));
  EXPECT_EQ(run("run c.toml --db c.db").exit_code, 0);
  write("c.toml", fmt::format(fmt::runtime(kPlain), ours + ", " + theirs, 0.01, "ours", 0.2, "violation"));
  const auto finished = run("run c.toml --db d.db");
  EXPECT_EQ(run("report d.db").exit_code, 4) << finished.err;
  EXPECT_THAT(
      run("report d.db").out,
      HasSubstr("theirs is under test, and no gate asks whether it breaks the safety distance in the contract"));
  EXPECT_THAT(run("report d.db --format junit --exit-zero").out, HasSubstr("<failure type=\"not judged\""));
  // Nor with a gate on something else.
  write("c.toml", fmt::format(fmt::runtime(kPlain), ours + ", " + theirs, 0.01, "theirs", 0.2, "hang") +
                      "[[gate]]\nname = \"h\"\nagent = \"ours\"\nlimit = 0.2\nmin_transports_per_agv_hour = 0\n");
  EXPECT_EQ(run("run c.toml --db e.db").exit_code, 4);
  // A reference agent needs none.
  const std::string reference = "{ name = \"theirs\", agent = \"reckless\", role = \"reference\" }";
  write("c.toml", fmt::format(fmt::runtime(kPlain), ours + ", " + reference, 0.01, "ours", 0.2, "violation"));
  EXPECT_EQ(run("run c.toml --db f.db").exit_code, 0);
}

// ---- what software takes from its process

// It is reckless or sound by the place of the program, by the number of its process, or by memory that it never wrote.
TEST_F(VerdictTricks, ACoinThatFallsOnceForTheNightIsNoVerdict) {
  for (const char* kind : {"coin-place", "coin-process", "coin-heap"}) {
    write("c.toml", fmt::format("replicates = 60\nhorizon_s = 120\n[factors]\nagents = [{}]\nlayouts = "
                                "[\"aisle-grid\"]\nfleet_sizes = [3]\nloss = [0.4]\ndelay_s = [2]\n[world]\n"
                                "transports_per_agv_hour = 60\n[coverage]\nprobes = []\n[[gate]]\nname = \"g\"\n"
                                "agent = \"{}\"\nlimit = 0.2\nmin_transports_per_agv_hour = 0.5\n",
                                test::unsteady(kind), kind));
    for (int time = 0; time < 3; ++time) EXPECT_NE(run("run c.toml --db c.db --overwrite").exit_code, 0) << kind;
  }
}

// It does not bear the second run of a process. The engine runs it again in a fresh one, and there it passes.
TEST_F(VerdictTricks, ARunThatEndsItsWorkerIsNotForgottenBecauseASecondAttemptPasses) {
  for (const char* kind : {"worn-abort", "worn-exit", "worn-loop"}) {
    write("c.toml", fmt::format(fmt::runtime(kPlain), test::unsteady(kind), 0.01, kind, 0.99, "violation") +
                        "[limits]\ncpu_s = 0.1\n");
    const auto finished = run("run c.toml --db c.db -j 1 --overwrite --replicates 24");
    EXPECT_EQ(finished.exit_code, 4) << kind << finished.out;
    const json report = json::parse(run("report c.db --format json --exit-zero").out);
    EXPECT_GE(report.at("audits").at(0).at("judged_otherwise"), 5) << kind;
    EXPECT_THAT(finished.out, HasSubstr("not deterministic | agent " + std::string(kind)));
  }
}

// Another program may have killed the worker: that is no verdict, and it is told.
TEST_F(VerdictTricks, WorkersThatAreKilledNowAndThenAreNamed) {
  write("c.toml", fmt::format(fmt::runtime(kPlain), test::unsteady("worn-kill"), 0.01, "worn-kill", 0.99, "violation"));
  (void)run("run c.toml --db c.db -j 1 --replicates 24");
  const std::string page = std::regex_replace(run("report c.db --exit-zero").out, std::regex("\\s+"), " ");
  EXPECT_THAT(page, testing::ContainsRegex("The worker process of [0-9]+ runs was killed or waited too long"));
  EXPECT_THAT(page, HasSubstr("this software ends its process now and then"));
}

TEST_F(VerdictTricks, WorkersThatWereLostStandInComparisons) {
  write("c.toml", fmt::format(fmt::runtime(kPlain), test::unsteady("worn-kill"), 0.01, "worn-kill", 0.99, "violation"));
  (void)run("run c.toml --db c.db -j 1 --replicates 24");
  EXPECT_THAT(run("compare c.db c.db").out,
              testing::ContainsRegex("both releases \\| sessions: .*The worker process of [0-9]+ runs was killed"));
  const json told = json::parse(run("compare c.db c.db --json").out);
  EXPECT_THAT(told.at("old").at("head").dump(), HasSubstr("this software ends its process now and then"));
  EXPECT_THAT(run("report c.db --baseline c.db --exit-zero --html page.html").err, testing::Not(HasSubstr("error")));
  EXPECT_THAT(read(path("page.html")), testing::ContainsRegex("The baseline \\| sessions: .*The worker process of"));
}

// Nobody else kills a worker in nearly every run.
TEST_F(VerdictTricks, WorkersThatAreKilledAgainAndAgainAreEndedByTheirSoftware) {
  write("c.toml", fmt::format(fmt::runtime(kPlain), test::unsteady("worn-kill"), 0.01, "worn-kill", 0.99, "violation"));
  EXPECT_EQ(run("run c.toml --db c.db -j 1 --replicates 24").exit_code, 4);
  std::filesystem::remove(path("c.sessions.jsonl"));
  const json report = json::parse(run("report c.db --format json --exit-zero").out);
  EXPECT_GE(report.at("audits").at(0).at("judged_otherwise"), 5);
}

// An exception ends no worker: it is the crash of that run.
TEST_F(VerdictTricks, AnExceptionInAUsedProcessIsACrash) {
  write("c.toml", fmt::format(fmt::runtime(kPlain), test::unsteady("worn-throw"), 0.01, "worn-throw", 0.2, "crash"));
  EXPECT_NE(run("run c.toml --db c.db -j 1 --replicates 24").exit_code, 0);
}

// The only gate looks away from the cells in which it crashes.
TEST_F(VerdictTricks, CrashesInCellsWithoutAGateAreTold) {
  std::string text =
      fmt::format(fmt::runtime(kPlain), "{ file = \"failing.so\", name = \"one\", config = \"abort 2\" }", 0.0, "one",
                  0.9, "violation");
  write("c.toml",
        std::regex_replace(text, std::regex("fleet_sizes = \\[3\\]"), "fleet_sizes = [2, 3]") + "fleet_size = 2\n");
  (void)run("run c.toml --db c.db -j 2 --replicates 12");
  const std::string page = std::regex_replace(run("report c.db --exit-zero").out, std::regex("\\s+"), " ");
  EXPECT_THAT(page, testing::ContainsRegex("one crashed in [0-9]+ of 24 runs of the contract region. No gate judges"));
}

// ---- the seam to foreign code

std::string untidy(const std::string& kind, const std::string& name) {
  return fmt::format("{{ file = \"{}\", name = \"{}\", config = \"{}\" }}", FLEETPROOF_UNTIDY_AGENT, name, kind);
}

TEST_F(VerdictTricks, APlugInThatRoundsUpwardChangesNoOtherSoftwareAndIsTold) {
  write("c.toml", fmt::format(fmt::runtime(kPlain), untidy("rounding", "one") + ", " + untidy("none", "other"), 0.1,
                              "other", 0.9, "violation"));
  (void)run("run c.toml --db c.db -j 1");
  const json report = json::parse(run("report c.db --format json --exit-zero").out);
  EXPECT_EQ(report.at("audits").at(0).at("processor_changed_runs"), 60);
  EXPECT_EQ(report.at("audits").at(1).at("processor_changed_runs"), 0);
  EXPECT_THAT(run("report c.db --exit-zero").out,
              HasSubstr("processor changed | agent one: in 60 runs it left another rounding"));
  EXPECT_EQ(run("run c.toml --db folded.db --keep failing").exit_code, run("report c.db").exit_code);
  EXPECT_EQ(json::parse(run("report folded.db --format json --exit-zero").out).at("audits"), report.at("audits"));
}

// It needs more CPU time to load than a run may use, and more than one process loads it.
TEST_F(VerdictTricks, WhatAPlugInDoesWhileItIsLoadedIsNoPartOfARunAndIsTold) {
  const std::string agent = fmt::format("{{ file = \"{}\", name = \"one\" }}", FLEETPROOF_LOADING_AGENT);
  write("c.toml", fmt::format(fmt::runtime(kPlain), agent, 0.1, "one", 0.9, "crash") + "[limits]\ncpu_s = 0.2\n");
  const auto finished = run("run c.toml --db c.db -j 1 --replicates 8");
  const json report = json::parse(run("report c.db --format json --exit-zero").out);
  EXPECT_THAT(finished.out, HasSubstr("0/8")) << finished.err;
#ifdef __x86_64__
  EXPECT_EQ(report.at("audits").at(0).at("processor_changed_runs"), 8);
#endif
  EXPECT_EQ(report.at("audits").at(0).at("differing"), 0) << "the count stands on the tape, too";
}

TEST_F(VerdictTricks, CallsFromAThreadOfTheAgentAreItsCrash) {
  write("c.toml", fmt::format(fmt::runtime(kPlain), untidy("other-thread", "one"), 0.1, "one", 0.01, "crash"));
  const auto finished = run("run c.toml --db c.db");
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_THAT(run("report c.db --format json").out, HasSubstr("called its controller from another thread"));
}

TEST_F(VerdictTricks, EveryClaimAboutAPlugInSaysWhatIsOutOfReach) {
  write("c.toml", fmt::format(fmt::runtime(kPlain), untidy("none", "one"), 0.1, "one", 0.9, "violation"));
  EXPECT_THAT(
      run("run c.toml --db c.db").out,
      HasSubstr("one is not built in. A shared object runs in the process of the engine that judges, all AGVs in one"));
}

// ---- the ledger

std::string in_one_line(const std::string& text) { return std::regex_replace(text, std::regex("\\s+"), " "); }

class LedgerTricks : public test::ProgramTest {
 protected:
  // A sound fleet under any name. The limit is not met by 60 worlds.
  void try_as(const std::string& name, const std::string& config = "", int seed = 1) {
    write("c.toml",
          fmt::format("seed = {}\nreplicates = 10\nhorizon_s = 60\n[factors]\nagents = [{{ agent = \"hull-lock\", "
                      "name = \"{}\", config = \"{}\", role = \"candidate\" }}]\nlayouts = [\"aisle-grid\"]\n"
                      "fleet_sizes = [3]\nloss = [0.1]\ndelay_s = [0.1]\n[coverage]\nprobes = []\n[[gate]]\n"
                      "name = \"gate of {}\"\nagent = \"{}\"\nlimit = 0.5\nmin_transports_per_agv_hour = 0\n",
                      seed, name, config, name, name));
    finished = run("run c.toml --db c.db --overwrite");
    ASSERT_EQ(finished.exit_code, 0) << finished.out << finished.err;
  }
  std::string head() const { return in_one_line(run("report c.db").out); }

  test::Finished finished;
};

TEST_F(LedgerTricks, AnotherNameParameterOrSeedHidesNoAttempt) {
  try_as("one");
  EXPECT_THAT(head(), HasSubstr("names no other attempt for this release"));
  EXPECT_THAT(head(), testing::Not(HasSubstr("by other software")));
  try_as("two");
  EXPECT_THAT(head(), HasSubstr("names 1 attempt at the same plan by other software (one, seed 1"));
  try_as("two", "zones_from=200");
  EXPECT_THAT(head(), HasSubstr("names 2 attempts at the same plan by other software (two, seed 1"));
  try_as("three", "", 2);
  EXPECT_THAT(head(), HasSubstr("names 3 attempts at the same plan by other software"));
}

TEST_F(LedgerTricks, WhatIsMissingStandsAtTheHead) {
  try_as("one");
  try_as("two");
  EXPECT_THAT(head(), testing::Not(HasSubstr("The session log names")));
  const std::string ledger = read(path("attempts.jsonl"));
  write("attempts.jsonl", ledger.substr(0, ledger.find('\n') + 1));
  EXPECT_THAT(head(), HasSubstr("The session log names a line of a ledger that is not there"));
  std::filesystem::remove(path("attempts.jsonl"));
  EXPECT_THAT(head(), HasSubstr("The session log names a line of a ledger that is not there"));
  write("attempts.jsonl", ledger.substr(ledger.find('\n', ledger.find('\n') + 1) + 1));
  EXPECT_THAT(head(), HasSubstr("somebody has changed the ledger"));
  write("attempts.jsonl", ledger);
  std::filesystem::remove(path("c.sessions.jsonl"));
  EXPECT_THAT(head(), HasSubstr("There is no session log beside the results file"));
}

TEST_F(LedgerTricks, ASessionLogThatNamesNoLedgerIsTold) {
  try_as("one");
  std::string log = read(path("c.sessions.jsonl"));
  ASSERT_THAT(log, HasSubstr("ledger_line"));
  log = std::regex_replace(log, std::regex(R"x("(attempt|ledger_line|ledger_hash)":("[^"]*"|[0-9]+),?)x"), "");
  write("c.sessions.jsonl", log);
  EXPECT_THAT(head(), HasSubstr("The session log names no line of a ledger"));
  write("c.sessions.jsonl", "");
  EXPECT_THAT(head(), HasSubstr("The session log names no line of a ledger"));
}

// The log of a campaign that nobody disturbed, beside the file of one in which workers were lost.
TEST_F(LedgerTricks, TheSessionLogOfAnotherFileIsTold) {
  try_as("one", "", 2);
  const std::string foreign = read(path("c.sessions.jsonl"));
  std::filesystem::remove(path("c.sessions.jsonl"));
  try_as("one");
  EXPECT_THAT(head(), testing::Not(HasSubstr("The session log is that of another")));
  const std::string own = read(path("c.sessions.jsonl"));
  const auto said = HasSubstr("The session log is that of another results file, or somebody changed this file");
  write("c.sessions.jsonl", foreign);
  EXPECT_THAT(head(), said);
  // Whoever writes the seal of this file into it is told by the ledger.
  const std::regex seal(R"x("seal":"[0-9a-f]{16}")x");
  std::smatch found;
  ASSERT_TRUE(std::regex_search(own, found, seal));
  write("c.sessions.jsonl", std::regex_replace(foreign, seal, found.str()));
  EXPECT_THAT(head(), said);
  write("c.sessions.jsonl", own);
  EXPECT_THAT(head(), testing::Not(said));
  // Another file of the same plan.
  std::filesystem::rename(path("c.db"), path("kept.db"));
  EXPECT_EQ(run("run c.toml --db c.db --replicates 20").exit_code, 0);
  write("c.sessions.jsonl", own);
  EXPECT_THAT(head(), said);
}

TEST_F(LedgerTricks, ASessionLogWithoutAnEndOrASealIsTold) {
  try_as("one");
  const std::string log = read(path("c.sessions.jsonl"));
  write("c.sessions.jsonl", log.substr(0, log.find('\n') + 1));
  EXPECT_THAT(head(), HasSubstr("The last session noted no end"));
  write("c.sessions.jsonl", std::regex_replace(log, std::regex(R"x(,"seal":"[0-9a-f]{16}")x"), ""));
  EXPECT_THAT(head(), HasSubstr("The session log does not say which file its last session left"));
  write("c.sessions.jsonl", log);
  EXPECT_THAT(head(), testing::Not(HasSubstr("The session log does not")));
  EXPECT_THAT(head(), testing::Not(HasSubstr("noted no end")));
}

TEST_F(LedgerTricks, ShardsAreToldToWriteIntoNoLedger) {
  try_as("one");
  ASSERT_EQ(run("run c.toml --shard 1/1 --out s").exit_code, 0);
  ASSERT_EQ(run("merge s --db m.db").exit_code, 0);
  EXPECT_THAT(in_one_line(run("report m.db").out), HasSubstr("what was run in shards, and not merged, is not known"));
}

// The object under a name is exchanged, and the campaign goes on.
TEST_F(VerdictTricks, RunsOfTwoProgramsAreNoEvidenceForOne) {
  const std::string text =
      fmt::format(fmt::runtime(kPlain), "{ file = \"it.so\", name = \"it\" }", 0.1, "it", 0.5, "crash") +
      "[[gate]]\nname = \"h\"\nagent = \"it\"\nlimit = 0.99\n"
      "min_transports_per_agv_hour = 0\n";
  write("c.toml", text);
  std::filesystem::copy_file(path("unsteady.so"), path("it.so"));
  ASSERT_EQ(run("run c.toml --db c.db --replicates 30").exit_code, 0);
  write("it.so", read(path("it.so")) + "another byte");
  EXPECT_EQ(run("run c.toml --db c.db --replicates 31").exit_code, 2);
  EXPECT_EQ(run("run c.toml --db c.db --replicates 31 --allow-drift").exit_code, 4);
  EXPECT_THAT(run("report c.db").out, HasSubstr("drift | more than one program made the runs of this file"));
  EXPECT_THAT(run("compare c.db c.db").out, HasSubstr("doubt: more than one program made the runs of the new release"));
}

TEST_F(LedgerTricks, TheBeginOfAFileThatWasMovedIsKnown) {
  try_as("one");
  const std::string begun = "was fixed before run 0, at 20";
  EXPECT_THAT(head(), HasSubstr(begun));
  std::filesystem::rename(path("c.db"), path("d.db"));
  std::filesystem::rename(path("c.sessions.jsonl"), path("d.sessions.jsonl"));
  EXPECT_THAT(in_one_line(run("report d.db").out), HasSubstr(begun));
  EXPECT_EQ(run("run c.toml --db d.db --replicates 20").exit_code, 0);
  EXPECT_THAT(in_one_line(run("report d.db").out), HasSubstr(begun));
  EXPECT_THAT(in_one_line(run("report d.db").out), HasSubstr("names no other attempt for this release"));
}

// ---- comparisons

struct Trick {
  const char *name, *old_lines, *new_lines;  // agent, and what else differs
  int exit_code;
  const char* sentence;
};

class ComparisonTricks : public VerdictTricks, public testing::WithParamInterface<Trick> {};

TEST_P(ComparisonTricks, HasItsExitCode) {
  const Trick& trick = GetParam();
  for (const auto& [name, lines] : {std::pair{"old", trick.old_lines}, {"new", trick.new_lines}}) {
    const std::string all = lines, agent = all.substr(0, all.find('|')), more = all.substr(all.find('|') + 1);
    write(std::string(name) + ".toml",
          fmt::format("replicates = 90\n{}{}\n[factors]\nagents = [{{ {}, name = \"ours\" }}]\n"
                      "layouts = [\"aisle-grid\"]\nfleet_sizes = [3]\nloss = [0.4]\ndelay_s = [2]\n[world]\n"
                      "transports_per_agv_hour = 60\n",
                      all.find("default_gates") == std::string::npos ? "default_gates = false\n" : "", more, agent));
    (void)run(fmt::format("run {0}.toml --db {0}.db", name));
  }
  const auto told = run("compare old.db new.db --fail-on-regression");
  EXPECT_EQ(told.exit_code, trick.exit_code) << told.out << told.err;
  EXPECT_THAT(told.out, HasSubstr(trick.sentence));
}

constexpr const char
    *kSound = "agent = \"hull-lock\"|horizon_s = 60",
    *kReckless = "agent = \"reckless\"|horizon_s = 60",
    *kCrashes = "file = \"failing.so\", config = \"abort 1\"|horizon_s = 60",
    *kAsksNothing = "agent = \"hull-lock\"|horizon_s = 60\n[coverage]\nprobes = []",
    *kNotAudited = "agent = \"hull-lock\"|horizon_s = 60\n[audit]\nshare = 0",
    *kWithGates = "agent = \"hull-lock\"|horizon_s = 60\ndefault_gates = true",
    *kHeld = "agent = \"hull-lock\"|horizon_s = 60\n[vary]\nhold = [\"layout\"]",
    *kExempt = "agent = \"hull-lock\"|horizon_s = 60\n[law]\nexempt_purposes = [\"charging\"]\nexempt_radius_m = 1",
    *kParked = "agent = \"scripted\"|horizon_s = 300";

INSTANTIATE_TEST_SUITE_P(
    Of, ComparisonTricks,
    testing::Values(
        Trick{"TheSame", kSound, kSound, 0, "violation   not worse within the margin: 0 -> 0"},
        Trick{"AnOldReleaseThatAlwaysCrashes", kCrashes, kReckless, 4, "violation   cannot tell"},
        Trick{"ANewReleaseThatAlwaysCrashes", kSound, kCrashes, 1, "crash       worse: 0 -> 90"},
        Trick{"AReleaseThatIsWorse", kSound, kReckless, 1, "violation   worse: 0 -> "},
        Trick{"AFleetThatIsParked", "agent = \"hull-lock\"|horizon_s = 300", kParked, 1, "throughput  worse: 0 -> "},
        Trick{"TwoFleetsThatAreParked", kParked, kParked, 4, "doubt: the new release completed no transport"},
        Trick{"RunsTooShortForATransport", "agent = \"hull-lock\"|horizon_s = 3", "agent = \"reckless\"|horizon_s = 3",
              4, "waived: what is easier here than usual: horizon_s = 3 s"},
        Trick{"ANewReleaseThatHadToMeetNothing", kSound, kAsksNothing, 4,
              "doubt: the new release did not have to meet encounter, negotiation?, and the other did"},
        Trick{"AnOldReleaseThatHadToMeetNothing", kAsksNothing, kSound, 4,
              "doubt: the old release did not have to meet"},
        Trick{"AWorseReleaseThatHadToMeetNothing", kAsksNothing, kReckless, 1, "violation   worse: 0 -> "},
        Trick{"ANewReleaseWithoutAudits", kSound, kNotAudited, 4,
              "doubt: 0 % of the runs of the new release were to be audited, and 1 % of the other's"},
        Trick{"AnOldReleaseWithoutAudits", kNotAudited, kSound, 4, "doubt: 0 % of the runs of the old release"},
        Trick{"ANewReleaseWithoutTheDefaultGates", kWithGates, kSound, 4,
              "doubt: the new release leaves the default gates out, and the other does not"},
        Trick{"WhatIsHeldInBoth", kHeld, kHeld, 0,
              "both releases | held: every replicate has the layout of replicate 0"},
        Trick{"WhatIsHeldInOne", kSound, kHeld, 4, "new release | held: every replicate has the layout of replicate 0"},
        Trick{"WhatIsExemptInBoth", kExempt, kExempt, 0, "both releases | exempt: AGVs within 1 m of a station for"},
        Trick{"WhatIsExemptInOne", kExempt, kSound, 4, "old release | exempt: AGVs within 1 m of a station for"},
        Trick{"AShorterRun", kSound, "agent = \"hull-lock\"|horizon_s = 50", 4, "the campaigns differ in horizon_s"},
        Trick{"AnotherSeedAndAShorterRun", kSound, "agent = \"hull-lock\"|horizon_s = 50\nseed = 2", 4,
              "the campaigns differ in horizon_s"},
        Trick{"AnotherSeed", kSound, "agent = \"hull-lock\"|horizon_s = 60\nseed = 2", 0,
              "90 worlds of each, drawn from other seeds"}),
    [](const auto& trick) { return std::string(trick.param.name); });

// Software that only looks at its own AGV, or that agrees through memory, loses nothing by a bad radio.
TEST_F(VerdictTricks, AgvsThatSendNoMessageAreNamed) {
  const auto head_of = [&](const std::string& agent, const std::string& keep) {
    const std::string words = fmt::format("{{ agent = \"{}\", name = \"ours\", role = \"candidate\" }}", agent);
    write("c.toml", fmt::format(fmt::runtime(kPlain), words, 0.01, "ours", 0.9, "violation"));
    (void)run("run c.toml --db c.db --overwrite --keep " + keep);
    return std::regex_replace(run("report c.db --exit-zero").out, std::regex("\\s+"), " ");
  };
  const auto said = HasSubstr("The AGVs of ours sent no message in 60 of 60 runs with two or more of them");
  for (const char* keep : {"all", "failing"}) {
    EXPECT_THAT(head_of("scripted", keep), said) << keep;
    const json report = json::parse(run("report c.db --format json --exit-zero").out);
    EXPECT_EQ(report.at("coverage").at("agents").at(0).at("silent_runs"), 60) << keep;
  }
  EXPECT_THAT(head_of("hull-lock", "all"), testing::Not(HasSubstr("sent no message")));
}

// Fifty runs that came out the same say less than a thousand.
TEST_F(VerdictTricks, AuditsWithoutADifferenceAreABoundAndNoProof) {
  write("c.toml", fmt::format(fmt::runtime(kPlain), test::unsteady("steady"), 1.0, "steady", 0.8, "violation"));
  const auto finished = run("run c.toml --db c.db");
  EXPECT_THAT(
      std::regex_replace(finished.out, std::regex("\\s+"), " "),
      HasSubstr("With 95 % confidence, at most 4.88 % of the runs of steady would come out otherwise if they were "
                "simulated once more: 60 were, and none did."))
      << "1 - 0.05^(1/60)";
}

// A ring of one-way segments: nobody comes towards or across anybody.
TEST_F(VerdictTricks, APlantOnWhichAgvsOnlyFollowEachOtherIsNamed) {
  std::string ring = "id,x,y,purposes\n";
  for (int i = 0; i < 8; ++i)
    ring += fmt::format("s{},{},{},storage\n", i, i < 4 ? 20 * i : 20 * (7 - i), i < 4 ? 0 : 20);
  ring += "from,to,bidirectional\n";
  for (int i = 0; i < 8; ++i) ring += fmt::format("s{},s{},false\n", i, (i + 1) % 8);
  write("ring.csv", ring);
  const auto demonstrated_on = [&](const std::string& layout) {
    write("c.toml", "replicates = 60\n[factors]\nagents = [\"hull-lock\"]\nlayouts = [" + layout +
                        "]\nfleet_sizes = [3]\nloss = [0.4]\ndelay_s = [2]\n[world]\ntransports_per_agv_hour = 30\n"
                        "[[gate]]\nname = \"g\"\nagent = \"hull-lock\"\nlimit = 0.2\n");
    const auto finished = run("run c.toml --db c.db --overwrite");
    EXPECT_EQ(finished.exit_code, 0) << finished.out << finished.err;
    return finished.out;
  };
  const auto named = HasSubstr("hull-lock only followed other AGVs: no run had drives of two AGVs that came head-on");
  EXPECT_THAT(demonstrated_on("{ file = \"ring.csv\" }"), named);
  EXPECT_THAT(demonstrated_on("\"aisle-grid\""), testing::Not(named));
}

}  // namespace
}  // namespace fleetproof::verdict_tricks_test
