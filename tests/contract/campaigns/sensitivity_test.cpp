// Which planted faults a campaign's worlds detect.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "campaign/batch/sensitivity.hpp"
#include "campaign/run/run_one.hpp"
#include "tests/contract/campaigns/small_campaign.hpp"
#include "tests/support/program.hpp"

namespace fleetproof::sensitivity_test {
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
      EXPECT_EQ(found.sound[0].all.runs, 24U) << "eight cells of one agent, three replicates";
    }
  }
}

// A fault that cannot show in a few short runs is missed: its runs are those of the sound agent.
TEST(Sensitivity, AFaultThatDoesNothingIsMissed) {
  const Sensitivity found =
      measure_sensitivity(test::small_plan(), AgentPrograms(), {.workers = 2, .agents = {"wraps-at-256"}});
  EXPECT_EQ(found.faults[0].seen_as, "");
  EXPECT_EQ(found.faults[0].tally.all.accused, found.sound[0].all.accused);
  EXPECT_FALSE(found.faults[0].tried);
  EXPECT_EQ(found.detected(), 0U);
}

// What is missed is told apart from what these worlds never ask for: here no AGV restarts, and each sends now and then.
TEST(Sensitivity, AMissedFaultActsAndAnUntriedOneDoesNot) {
  const Sensitivity found =
      measure_sensitivity(test::small_plan(), AgentPrograms(),
                          {.runs = 1, .workers = 2, .agents = {"restart-forgets-lane", "grants-at-boot", "asks-once"}});
  EXPECT_FALSE(found.faults[0].tried);
  EXPECT_FALSE(found.faults[1].tried);
  EXPECT_TRUE(found.faults[2].tried) << "a lost message is not sent again";
  EXPECT_EQ(found.faults[2].seen_as, "") << "one run shows no rate";
}

// Where even the sound agent is accused, one violation shows nothing.
TEST(Sensitivity, AmongBodiesThatNoAgentSensesOnlyARateCounts) {
  CampaignPlan plan = test::small_plan();
  plan.replicates = 20;
  plan.faults.obstacles_per_hour = 600.0;
  const Sensitivity found = measure_sensitivity(
      plan, AgentPrograms(), {.runs = 40, .workers = 2, .agents = {"wraps-at-256", "grants-for-good"}});
  ASSERT_GT(found.sound[0].all.with("violation"), 0U);
  EXPECT_EQ(found.faults[0].seen_as, "") << "the same runs as those of the sound agent";
  EXPECT_EQ(found.faults[1].runs, 40U) << "no fault ends at its first violation here";
}

// The faults that are found soon; tests/soak/kill_table has all of them.
TEST_F(Sensitive, TheShortStandardCampaignDetectsFaultsInItsFirstReplicates) {
  const std::vector<std::string> faults = {
      "timeout-grant",     "no-overhang",        "names-not-shapes", "stale-grant",
      "counts-messages",   "ignores-parked",     "grants-at-boot",   "grants-for-good",
      "lock-expires",      "forgets-boot",       "asks-once",        "bends-as-chords",
      "overtaken-goes-on", "failure-frees-lane", "kinds-by-size",    "arrival-order"};
  std::string words;
  for (const std::string& fault : faults) words += " --agent " + fault;
  const auto finished = run("sensitivity '" + kShort + "' --json --runs 896" + words);
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  const auto found = nlohmann::json::parse(finished.out);
  EXPECT_EQ(found["sound"][0]["violating_runs"], 0U) << "the sound agent is accused";
  ASSERT_EQ(found["faults"].size(), faults.size());
  for (const auto& fault : found["faults"]) EXPECT_TRUE(fault["detected"]) << fault.dump();
}

const std::string kCorridor =
    "replicates = 10\nhorizon_s = 120\n[factors]\nagents = [\"reckless\"]\n"
    "layouts = [\"corridor-sidings\"]\nfleet_sizes = [4]\nloss = [0.4]\ndelay_s = [2]\n"
    "[world]\ntransports_per_agv_hour = 120\n";

TEST_F(Sensitive, SaysWhatItDetectsAndWhatItMisses) {
  write("a.toml", kCorridor);
  const auto finished = run("sensitivity a.toml --agent grants-for-good --agent wraps-at-256");
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("detects 1 of 2 planted faults within 10 runs; never tries wraps-at-256; 32 more "
                                      "were not measured\n"));
  EXPECT_THAT(finished.out, HasSubstr("  wraps-at-256             never tried: in each run the same as the sound"));
  EXPECT_THAT(finished.out, HasSubstr("(corridor-sidings, 4 AGVs, 40 %, 2 s"));
  EXPECT_THAT(finished.err, Not(HasSubstr("warning")));
  const auto unknown = run("sensitivity a.toml --agent reckless -o other.json");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("\"reckless\" is not an agent with a planted fault"));
  EXPECT_EQ(run("sensitivity a.toml --runs 0").exit_code, 2);
  EXPECT_THAT(run("sensitivity a.toml --agent stale-grant --agent stale-grant").err,
              HasSubstr("\"stale-grant\" is given twice; name each agent once"));
}

TEST_F(Sensitive, OfACentralFleetTriesFaultsOfItsOwnPrograms) {
  std::string campaign = kCorridor;
  campaign.replace(campaign.find("\"reckless\""), std::string_view("\"reckless\"").size(),
                   "{ vehicle = \"follower\", computer = \"zone-server\" }");
  write("a.toml", campaign);
  const auto finished = run("sensitivity a.toml --agent drops-after-a-second --agent waits-for-former-self");
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("  drops-after-a-second     stuck more often "));
  EXPECT_THAT(finished.out, HasSubstr("  waits-for-former-self    never tried")) << "no AGV restarts here";
  EXPECT_THAT(finished.out, HasSubstr("zone-server+follower in 10 runs"));
  EXPECT_THAT(finished.out, HasSubstr("13 more were not measured"));
  const auto unknown = run("sensitivity a.toml --agent stale-grant -o other.json");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("\"stale-grant\" is not an agent with a planted fault of zone-server+follower"));
}

// The faults of each family are compared with the sound software of their own family.
TEST_F(Sensitive, OfBothFamiliesTriesTheFaultsOfBoth) {
  std::string campaign = kCorridor;
  campaign.replace(campaign.find("\"reckless\""), std::string_view("\"reckless\"").size(),
                   "{ vehicle = \"follower\", computer = \"zone-server\" }, \"hull-lock\"");
  write("a.toml", campaign);
  const auto finished = run("sensitivity a.toml --agent drops-after-a-second --agent grants-for-good");
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("hull-lock in 10 runs"));
  EXPECT_THAT(finished.out, HasSubstr("zone-server+follower in 10 runs"));
  EXPECT_THAT(finished.out, HasSubstr("detects 2 of 2 planted faults within 10 runs; 47 more were not measured"));
  const auto found = nlohmann::json::parse(read(path("a.sensitivity.json")));
  ASSERT_EQ(found["sound"].size(), 2U);
  EXPECT_EQ(found["faults"][0]["agent"], "grants-for-good");
  EXPECT_EQ(found["faults"][0]["sound"], "hull-lock");
  EXPECT_EQ(found["faults"][1]["agent"], "drops-after-a-second");
  EXPECT_EQ(found["faults"][1]["sound"], "zone-server+follower");
  EXPECT_THAT(run("sensitivity a.toml --agent reckless -o other.json").err,
              HasSubstr("is not an agent with a planted fault of hull-lock or zone-server+follower"));
}

TEST_F(Sensitive, FewerFaultsDoNotTakeThePlaceOfMore) {
  write("a.toml", kCorridor);
  const std::string two = "sensitivity a.toml --runs 1 --agent grants-for-good --agent wraps-at-256";
  ASSERT_EQ(run(two).exit_code, 0);
  const std::string kept = read(path("a.sensitivity.json"));
  const auto refused = run("sensitivity a.toml --runs 1 --agent asks-once");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("a.sensitivity.json: holds 2 planted faults measured in these worlds, and --agent "
                                     "names 1; name another file with --output, or remove this one"));
  EXPECT_EQ(read(path("a.sensitivity.json")), kept);
  const auto elsewhere = run("sensitivity a.toml --runs 1 --agent asks-once -o b.json");
  EXPECT_EQ(elsewhere.exit_code, 0);
  EXPECT_THAT(elsewhere.err, HasSubstr("b.json: written\n"));
  EXPECT_EQ(run(two).exit_code, 0) << "as many as before";
}

TEST_F(Sensitive, SeveralSeedsGiveTheMedianOfEachAlone) {
  write("a.toml", kCorridor);
  const auto runs_of = [&](const std::string& words) {
    const auto finished = run("sensitivity a.toml --json --agent overtaken-if-granted --agent lock-expires " + words);
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    std::vector<double> runs;
    const auto found = nlohmann::json::parse(finished.out);
    for (const auto& fault : found["faults"])
      runs.push_back(fault["median_runs"].is_null() ? 1e9 : fault["median_runs"].get<double>());
    return runs;
  };
  const auto all = runs_of("--seed 1 --seeds 3");
  const std::vector<std::vector<double>> alone = {runs_of("--seed 1"), runs_of("--seed 2"), runs_of("--seed 3")};
  for (std::size_t fault = 0; fault < 2; ++fault) {
    std::vector<double> runs = {alone[0][fault], alone[1][fault], alone[2][fault]};
    std::ranges::sort(runs);
    EXPECT_EQ(all[fault], runs[1]) << fault;
  }
  EXPECT_LT(all[1], 1e9) << "two of three seeds detect it";
}

// Of these seeds, 4 has bodies in the way of the sound agent, so that only a rate counts; 5 and 6 have none.
TEST_F(Sensitive, SeedsThatDisagreeAreToldAsMostOfThemAre) {
  write("a.toml", kCorridor + "[faults]\nobstacles_per_hour = 6\n");
  const auto fault_of = [&](const std::string& words) {
    return nlohmann::json::parse(run("sensitivity a.toml --json --agent grants-for-good " + words).out)["faults"][0];
  };
  const auto rate = fault_of("--seed 4"), violation = fault_of("--seed 5");
  ASSERT_TRUE(rate["by_rate"]);
  ASSERT_FALSE(violation["by_rate"]);
  const auto mostly_violations = fault_of("--seed 4 --seeds 3"), tied = fault_of("--seed 4 --seeds 2");
  for (const auto& fault : {mostly_violations, tied}) {
    EXPECT_FALSE(fault["by_rate"]);
    EXPECT_EQ(fault["seen_as"], violation["seen_as"]);
    EXPECT_EQ(fault["cell"], violation["cell"]);
    EXPECT_EQ(fault["most_runs"], 10) << "a rate takes all runs";
  }
  const auto mostly_rates = fault_of("--seed 3 --seeds 3");
  EXPECT_TRUE(mostly_rates["by_rate"]);
  EXPECT_EQ(mostly_rates["seen_as"], rate["seen_as"]);
  EXPECT_EQ(mostly_rates["cell"], rate["cell"]);
  EXPECT_TRUE(mostly_rates["median_runs"].is_null());
}

// The report finds the file beside the results file, whatever agents, seed and number of replicates were tried.
TEST_F(Sensitive, StandsInTheReportOfThePlan) {
  write("a.toml", kCorridor);
  ASSERT_TRUE(test::has_verdict(run("run a.toml")));
  EXPECT_THAT(run("report a.db").out, HasSubstr("Not measured."));
  ASSERT_EQ(run("sensitivity a.toml --agent grants-for-good --agent wraps-at-256 --seeds 2 --seed 7").exit_code, 0);
  const std::string page = run("report a.db --format markdown").out;
  EXPECT_THAT(page, HasSubstr("a campaign in these worlds detects 1 of 2 planted faults within 10 runs; never tries "
                              "wraps-at-256; 32 more were not measured."));
  EXPECT_THAT(page, HasSubstr("grants all requests of an AGV once it has granted one"));
  EXPECT_THAT(page, HasSubstr("hull-lock had no violation in 20 runs. A fault was never tried if its agent did the"));
  const auto json = nlohmann::json::parse(run("report a.db --json").out)["sensitivity"];
  EXPECT_EQ(json["seeds"], (nlohmann::json{7, 8}));
  EXPECT_EQ(json["faults"][1]["agent"], "wraps-at-256");
  ASSERT_TRUE(test::has_verdict(run("report a.db --html a.html --no-film")));
  EXPECT_THAT(read(path("a.html")), HasSubstr("grants all requests of an AGV once it has granted one"));
}

TEST_F(Sensitive, OfOtherWorldsOrDamagedIsNotShown) {
  write("a.toml", kCorridor);
  write("b.toml", kCorridor + "hot_spot_skew = 0.5\n");
  ASSERT_TRUE(test::has_verdict(run("run a.toml")));
  ASSERT_EQ(run("sensitivity b.toml --runs 1 --agent asks-once -o a.sensitivity.json").exit_code, 0);
  const auto page = [&] { return run("report a.db --format markdown").out; };
  EXPECT_THAT(page(), HasSubstr("Not known: a.sensitivity.json was measured in the worlds of another plan"));
  for (const char* text : {"", "{}", "{\"schema_version\":3}", "[1", "{\"schema_version\":[]}"}) {
    write("a.sensitivity.json", text);
    EXPECT_THAT(page(), HasSubstr("Not known: a.sensitivity.json is damaged")) << text;
  }
  std::filesystem::remove(path("a.sensitivity.json"));
  std::filesystem::create_directory(path("a.sensitivity.json"));
  EXPECT_THAT(page(), HasSubstr("Not known: a.sensitivity.json: is a folder"));
  std::filesystem::remove(path("a.sensitivity.json"));
  write("a.sensitivity.json", "my notes");
  const auto refused = run("sensitivity a.toml --runs 1 --agent asks-once");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("is there already and is not a measured sensitivity"));
  EXPECT_EQ(read(path("a.sensitivity.json")), "my notes");
}

}  // namespace
}  // namespace fleetproof::sensitivity_test
