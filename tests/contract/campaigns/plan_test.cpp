// The pilot and what is forecast from it.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <numeric>
#include <set>

#include "campaign/batch/pilot.hpp"
#include "reports/evidence/binomial.hpp"
#include "tests/contract/campaigns/small_campaign.hpp"
#include "tests/support/program.hpp"

namespace fleetproof::plan_test {
namespace {

using testing::HasSubstr;

TEST(Pilot, AWholeSmallPlanIsRunAndEveryCellHasItsCost) {
  CampaignPlan plan = test::small_plan();
  plan.audit.share = 0.0;
  const Pilot pilot = run_pilot(plan, AgentPrograms(), 2, {.time = std::chrono::hours(1)});
  EXPECT_EQ(pilot.runs, plan.run_count());
  ASSERT_EQ(pilot.cells.size(), plan.cell_count());
  for (const CellCost& cell : pilot.cells) {
    EXPECT_EQ(cell.runs, plan.replicates);
    EXPECT_GT(cell.mean_s, 0.0);
  }
  EXPECT_LE(pilot.forecast_s(plan.replicates), pilot.elapsed_s * 1.0001)
      << "the runs of a worker follow each other, and all of them lie within the elapsed time";
}

TEST(Pilot, AShortPilotTakesCellsFromTheWholeReplicate) {
  CampaignPlan plan = test::small_plan();
  plan.replicates = 1'000'000;
  plan.factors[Factor::Loss] = {0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9};
  plan.factors[Factor::Delay] = {0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5};
  const Pilot pilot = run_pilot(plan, AgentPrograms(), 1, {.time = std::chrono::hours(1), .runs = 40});
  ASSERT_EQ(pilot.runs, 40U);
  ASSERT_GT(plan.cell_count(), 40U) << "the test is about a part of the first replicate";
  const auto runs_of_half = [&](std::size_t half) {
    const auto begin = pilot.cells.begin() + static_cast<std::ptrdiff_t>(half * pilot.cells.size() / 2);
    return std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(pilot.cells.size() / 2), std::uint64_t{0},
                           [](std::uint64_t sum, const CellCost& cell) { return sum + cell.runs; });
  };
  EXPECT_NEAR(double(runs_of_half(0)), double(runs_of_half(1)), 3.0) << "layouts vary slowest: both were visited";
  for (const CellCost& cell : pilot.cells) EXPECT_GT(cell.mean_s, 0.0) << "unvisited cells have the mean of the others";
}

TEST(Pilot, TheForecastFollowsFromTheCosts) {
  Pilot pilot;
  pilot.workers = 2;
  pilot.cells = {{10, 0.5}, {10, 1.5}};
  EXPECT_DOUBLE_EQ(pilot.replicate_s(), 2.0);
  EXPECT_DOUBLE_EQ(pilot.forecast_s(10), 10.0);
  EXPECT_EQ(pilot.replicates_within(10.5), 10U);
  EXPECT_DOUBLE_EQ(pilot.runs_per_s(), 2.0);
  pilot.audit_share = 0.5;
  pilot.first_audits_s = 3.0;
  EXPECT_DOUBLE_EQ(pilot.forecast_s(10), 16.5);
  EXPECT_EQ(pilot.replicates_within(16.6), 10U);
  EXPECT_EQ(pilot.replicates_within(1.0), 0U) << "the first audits alone take longer";
}

class Plan : public test::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write("a.toml", campaign("claim", "reckless"));
  }
  static std::string campaign(const std::string& kind, const std::string& judged) {
    return "kind = \"" + kind +
           "\"\nhorizon_s = 20\nreplicates = 30\n[factors]\nagents = [\"reckless\", \"hull-lock\"]\n"
           "layouts = [\"aisle-grid\"]\nfleet_sizes = [3]\n[audit]\nshare = 0\n[[gate]]\nname = \"g\"\nagent = \"" +
           judged + "\"\nlimit = 0.01\nmethod = \"fixed\"\nconfidence = 0.9\nregion = \"all\"\n";
  }
};

TEST_F(Plan, SaysWhatTheFileAndTheTimeGive) {
  const auto finished = run("plan a.toml --max-time 2h --json --jobs 2");
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  const auto json = nlohmann::json::parse(finished.out);
  EXPECT_EQ(json["cells"], 2);
  EXPECT_EQ(json["pilot"]["runs"], 60);
  EXPECT_EQ(json["file"]["replicates"], 30);
  const double replicate_s = json["file"]["time_s"].get<double>() / 30.0;
  const std::uint64_t in_time = json["in_time"]["replicates"];
  EXPECT_NEAR(static_cast<double>(in_time) * replicate_s, 7200.0, 7200.0 * 1e-3);
  const auto& gate = json["gates"][0];
  EXPECT_EQ(gate["cells"], 1);
  EXPECT_DOUBLE_EQ(gate["bound_of_file"], upper_bound(0, 30, 0.9));
  EXPECT_DOUBLE_EQ(gate["bound_in_time"], upper_bound(0, in_time, 0.9));
  EXPECT_EQ(gate["limit_met_by"]["replicates"], 230) << "ln(0.1) / ln(0.99), rounded up";
  const auto& costs = json["costs"]["agent"];
  ASSERT_EQ(costs.size(), 2U);
  EXPECT_THAT((std::set<std::string>{costs[0]["what"], costs[1]["what"]}),
              testing::ElementsAre("hull-lock", "reckless"));
  EXPECT_GE(costs[0]["share"], costs[1]["share"]) << "the most expensive first";
  EXPECT_NEAR(costs[0]["share"].get<double>() + costs[1]["share"].get<double>(), 1.0, 1e-3);
  EXPECT_EQ(json["costs"]["in_no_gate"]["cells"], 1);
  EXPECT_THAT(run("plan a.toml").out, HasSubstr("1 of 2 cells are judged by no gate"));
  for (const auto& entry : std::filesystem::directory_iterator(folder_))
    EXPECT_NE(entry.path().extension(), ".db") << "a pilot stores nothing";
}

TEST_F(Plan, CheckEstimatesFromOneRunOfEachCell) {
  const auto checked = run("check a.toml");
  EXPECT_EQ(checked.exit_code, 0) << checked.err;
  EXPECT_THAT(checked.out, HasSubstr("2 cells x 30 replicates = 60 runs of 20 s; about "));
  EXPECT_THAT(checked.out, HasSubstr(" of one core, as 2 runs took "));
}

TEST_F(Plan, ASearchAndAGateWithoutCellsHaveNoBounds) {
  write("s.toml", campaign("search", "reckless"));
  EXPECT_THAT(run("plan s.toml").out, HasSubstr("a search gives counts, no bounds"));
  EXPECT_EQ(run("plan a.toml --max-time soon").exit_code, 2);
  EXPECT_EQ(run("plan a.toml --jobs 0").exit_code, 2);
}

}  // namespace
}  // namespace fleetproof::plan_test
