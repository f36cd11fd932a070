// Which planted faults a campaign's worlds detect.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "campaign/batch/sensitivity.hpp"
#include "campaign/run/run_one.hpp"
#include "tests/contract/small_campaign.hpp"
#include "tests/support/program.hpp"

namespace fleetproof {
namespace {

using testing::HasSubstr;
using testing::Not;

using Sensitive = test::ProgramTest;

const std::string kShort = test::source("tests/campaigns/standard-short.toml");

// Counted one run after the other, as a campaign of this agent alone would.
std::uint64_t runs_until_violation(CampaignPlan plan, const char* agent) {
  plan.agents = {agent};
  const AgentPrograms programs;
  const RunOne run_one(plan, programs);
  for (std::uint64_t run = 0; run < plan.run_count(); ++run) {
    if (run_one(run).outcome.violation) return run + 1;
  }
  return 0;
}

TEST(Sensitivity, CountsTheRunsUntilTheFirstViolationOnAnyNumberOfWorkers) {
  const CampaignPlan plan = test::small_plan();
  for (const char* agent : {"overtaken-if-granted", "stale-grant", "early-release"}) {
    const std::uint64_t expected = runs_until_violation(plan, agent);
    for (const int workers : {1, 3}) {
      const Sensitivity found = measure_sensitivity(plan, AgentPrograms(), {.workers = workers, .agents = {agent}});
      ASSERT_EQ(found.faults.size(), 1U);
      EXPECT_EQ(found.faults[0].seen_as.empty(), expected == 0) << agent;
      EXPECT_EQ(found.faults[0].runs, expected == 0 ? 24 : expected) << agent;
      EXPECT_EQ(found.sound.runs, 24U) << "eight cells of one agent, three replicates";
    }
  }
}

// A fault that cannot show in a few short runs is missed: its runs are those of the sound agent.
TEST(Sensitivity, AFaultThatDoesNothingIsMissed) {
  const Sensitivity found =
      measure_sensitivity(test::small_plan(), AgentPrograms(), {.workers = 2, .agents = {"wraps-at-256"}});
  EXPECT_EQ(found.faults[0].seen_as, "");
  EXPECT_EQ(found.faults[0].tally.accused, found.sound.accused);
  EXPECT_EQ(found.detected(), 0U);
}

// Where even the sound agent is accused, one violation shows nothing.
TEST(Sensitivity, AmongBodiesThatNoAgentSensesOnlyARateCounts) {
  CampaignPlan plan = test::small_plan();
  plan.replicates = 20;
  plan.faults.obstacles_per_hour = 600.0;
  const Sensitivity found = measure_sensitivity(
      plan, AgentPrograms(), {.runs = 40, .workers = 2, .agents = {"wraps-at-256", "grants-for-good"}});
  ASSERT_GT(found.sound.accused.at("violation"), 0U);
  EXPECT_EQ(found.faults[0].seen_as, "") << "the same runs as those of the sound agent";
  EXPECT_EQ(found.faults[1].runs, 40U) << "no fault ends at its first violation here";
}

// The faults that are found soon; tests/soak/kill_table has all of them.
TEST_F(Sensitive, TheShortStandardCampaignDetectsFaultsInItsFirstReplicates) {
  const std::vector<std::string> faults = {
      "timeout-grant",  "no-overhang",     "names-not-shapes",  "stale-grant",       "counts-messages",
      "ignores-parked", "grants-at-boot",  "grants-for-good",   "lock-expires",      "forgets-boot",
      "asks-once",      "bends-as-chords", "overtaken-goes-on", "failure-frees-lane"};
  std::string words;
  for (const std::string& fault : faults) words += " --agent " + fault;
  const auto finished = run("sensitivity '" + kShort + "' --json --runs 832" + words);
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  const auto found = nlohmann::json::parse(finished.out);
  EXPECT_EQ(found["sound"]["accused_runs"].count("violation"), 0U) << "the sound agent is accused";
  ASSERT_EQ(found["faults"].size(), faults.size());
  for (const auto& fault : found["faults"]) EXPECT_TRUE(fault["detected"]) << fault.dump();
}

TEST_F(Sensitive, SaysWhatItDetectsAndWhatItMisses) {
  write("a.toml",
        "replicates = 10\nhorizon_s = 120\n[factors]\nagents = [\"reckless\"]\n"
        "layouts = [\"corridor-sidings\"]\nfleet_sizes = [4]\nloss = [0.4]\ndelay_s = [2]\n"
        "[world]\ntransports_per_agv_hour = 120\n");
  const auto finished = run("sensitivity a.toml --agent grants-for-good --agent wraps-at-256");
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("detects 1 of 2 planted faults; misses wraps-at-256\n"));
  EXPECT_THAT(finished.out, HasSubstr("  wraps-at-256             missed in 10 runs\n"));
  EXPECT_THAT(finished.out, HasSubstr("(corridor-sidings, 4 AGVs, 40 %, 2 s"));
  EXPECT_THAT(finished.err, Not(HasSubstr("warning")));
  const auto unknown = run("sensitivity a.toml --agent reckless");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("\"reckless\" is not an agent with a planted fault"));
  EXPECT_EQ(run("sensitivity a.toml --runs 0").exit_code, 2);
}

}  // namespace
}  // namespace fleetproof
