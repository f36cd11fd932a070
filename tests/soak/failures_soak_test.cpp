// The verbs on failures, in numbers: all violating runs of a campaign, many calls on unsteady software, and long runs.
#include <gmock/gmock.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "tests/contract/audits/audited_campaign.hpp"

namespace fleetproof::failures_soak_test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

class FailuresSoak : public test::AuditedCampaign {};

// Against the rule of tests/recount/leading.py, with `replay`, `shrink` and `explain` of each run.
TEST_F(FailuresSoak, EachVerbLeadsWithTheHeaviestJudgedFailureOfEachRun) {
  std::string text = read(test::source("tests/campaigns/standard-short.toml"));
  const std::string sound = "agents = [\"hull-lock\"]";
  text.replace(text.find(sound), sound.size(), "agents = [\"timeout-grant\", \"restart-forgets-lane\"]");
  write("c.toml", text);
  write("long-haul.json", read(test::source("tests/campaigns/long-haul.json")));
  ASSERT_TRUE(test::has_verdict(run("run c.toml --db c.db --replicates 4")));
  const auto checked =
      shell("python3 -B '" + test::source("tests/recount/check_leading.py") + "' \"$FLEETPROOF\" c.db 60");
  EXPECT_EQ(checked.exit_code, 0) << checked.out;
}

TEST_F(FailuresSoak, UnsteadySoftwareIsNeverShrunkToAnotherFailure) {
  constexpr int calls = 200;
  write_campaign(test::unsteady("coin-place") + ", " + test::unsteady("place"), 12, 1.0);
  run("run c.toml --db c.db");
  const auto runs = shell(
      "python3 -c 'import sqlite3\nfor (run,) in sqlite3.connect(\"c.db\").execute(\"SELECT run_index FROM runs WHERE "
      "contact\"): print(run)'");
  std::istringstream lines(runs.out);
  std::vector<std::string> indices;
  for (std::string line; std::getline(lines, line);) indices.push_back(line);
  ASSERT_FALSE(indices.empty());
  int refused = 0;
  for (int call = 0; call < calls; ++call) {
    const std::string& index = indices[static_cast<std::size_t>(call) % indices.size()];
    const auto finished = run("shrink c.db " + index + " --json --max-time 60 --max-trials 100");
    refused += finished.exit_code == 2 ? 1 : 0;
    if (finished.exit_code == 2) {
      EXPECT_THAT(finished.err, HasSubstr("repetitions in fresh processes failed so"));
      continue;
    }
    ASSERT_EQ(finished.exit_code, 0) << finished.err;
    const json told = json::parse(finished.out);
    EXPECT_THAT(told["failure"].get<std::string>(), StartsWith("contact"));
    EXPECT_THAT(json::parse(read(path(told["case"])))["expected"]["failure"].get<std::string>(), StartsWith("contact"));
  }
  EXPECT_GT(refused, 0);
}

// 20 AGVs and an hour. The clock is that of the wall, so an idle machine is needed.
TEST_F(FailuresSoak, TheBoundsOfTimeAreKeptWithinTenPercent) {
  write("long.toml",
        "name = \"long\"\nseed = 3\nhorizon_s = 3600\nreplicates = 8\n[factors]\nagents = [\"timeout-grant\"]\n"
        "layouts = [\"aisle-grid\"]\nfleet_sizes = [20]\nloss = [0.3]\ndelay_s = [1]\n"
        "[world]\ntransports_per_agv_hour = 20\n");
  run("run long.toml --db long.db");
  for (const std::string verb : {"explain long.db 0", "shrink long.db 0", "findings long.db"}) {
    for (const int bound_s : {10, 20}) {
      const auto begin = std::chrono::steady_clock::now();
      const auto finished = run(verb + " --max-time " + std::to_string(bound_s));
      const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
      EXPECT_NE(finished.exit_code, 3) << finished.err;
      EXPECT_LE(took.count(), 1.1 * bound_s) << verb;
    }
  }
}

}  // namespace
}  // namespace fleetproof::failures_soak_test
