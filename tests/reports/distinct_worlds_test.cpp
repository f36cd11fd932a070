// Worlds that repeat others are no evidence of their own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reports/evidence/binomial.hpp"
#include "reports/formats/json_report.hpp"
#include "reports/formats/text_report.hpp"
#include "reports/sections/condition_table.hpp"
#include "reports/sections/weak_points.hpp"
#include "tests/reports/sample_campaign.hpp"
#include "tests/reports/synthetic_campaigns.hpp"

namespace fleetproof::distinct_worlds_test {
namespace {

using samples::campaign_of;
using samples::grid;
using samples::report_of;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

GateRecord gate(double limit, GateUnit unit = GateUnit::World, GateMethod method = GateMethod::AnyTime) {
  GateRecord gate;
  gate.name = "safe";
  gate.agent = "sound";
  gate.limit = limit;
  gate.unit = unit;
  gate.method = method;
  return gate;
}

void all_alike(RunRecord& run) { run.repeats = run.replicate > 0; }

TEST(DistinctWorlds, EqualRunsCountOnce) {
  for (const GateMethod method : {GateMethod::AnyTime, GateMethod::Fixed}) {
    const auto input = report_of(campaign_of("claim", 340), grid({"sound"}, {0.0, 0.4}, {2.0}),
                                 {gate(0.01, GateUnit::World, method)}, all_alike);
    EXPECT_EQ(input.gates[0].verdict, Verdict::NotDemonstrated);
    EXPECT_EQ(input.gates[0].claim->units, 1U);
    EXPECT_EQ(input.gates[0].optimistic->units, 340U);
    EXPECT_THAT(render_text(input),
                AllOf(HasSubstr("in 0 of 340 worlds, 1 distinct"), HasSubstr("of 340 worlds, 1 is distinct")));
    EXPECT_THAT(weak_points(input), Contains(HasSubstr("2 of 2 cells always have the same run")));
  }
}

// Each world that failed counts, however often it is repeated, and each world of which nothing is known.
TEST(DistinctWorlds, ARepeatedFailureCountsEachTime) {
  const auto input =
      report_of(campaign_of("claim", 100), grid({"sound"}, {0.4}, {2.0}), {gate(0.1)}, [](RunRecord& run) {
        all_alike(run);
        if (run.replicate % 2 == 1) samples::violate(run);
        if (run.replicate % 4 == 2) run.outcome.crash = true;
      });
  EXPECT_EQ(input.gates[0].claim->failing, 75U);
  EXPECT_EQ(input.gates[0].claim->units, 76U) << "and the first of those that passed";
  EXPECT_EQ(input.gates[0].optimistic->failing, 50U);
  EXPECT_EQ(input.gates[0].optimistic->units, 100U) << "what refutes counts all";
  EXPECT_EQ(input.gates[0].verdict, Verdict::Violated);
}

TEST(DistinctWorlds, OneNewRunMakesAWorldNew) {
  const auto input = report_of(campaign_of("claim", 60), grid({"sound"}, {0.0, 0.4}, {2.0}), {gate(0.1)},
                               [](RunRecord& run) { run.repeats = run.replicate > 0 && run.cell == 0; });
  EXPECT_EQ(input.gates[0].claim->units, 60U);
  EXPECT_EQ(input.gates[0].verdict, Verdict::Demonstrated) << input.gates[0].reason;
}

// The new run has to be one of the gate's cells.
TEST(DistinctWorlds, ARunOfAnotherCellDoesNotHelp) {
  GateRecord of_one_cell = gate(0.1);
  of_one_cell.where.factors[Factor::Loss] = 0.0;
  const auto input = report_of(campaign_of("claim", 60), grid({"sound"}, {0.0, 0.4}, {2.0}), {of_one_cell},
                               [](RunRecord& run) { run.repeats = run.replicate > 0 && run.cell == 0; });
  EXPECT_EQ(input.gates[0].claim->units, 1U);
  EXPECT_EQ(input.gates[0].verdict, Verdict::NotDemonstrated);
}

TEST(DistinctWorlds, EachCellHasToPassWithItsOwnRuns) {
  const auto only_the_second = [](RunRecord& run) { run.repeats = run.replicate > 2 && run.cell == 1; };
  const auto cells = grid({"sound"}, {0.0, 0.4}, {2.0});
  EXPECT_EQ(report_of(campaign_of("claim", 60), cells, {gate(0.1)}, only_the_second).gates[0].verdict,
            Verdict::Demonstrated)
      << "as worlds, all are new";
  const auto input = report_of(campaign_of("claim", 60), cells, {gate(0.1, GateUnit::Run)}, only_the_second);
  EXPECT_EQ(input.gates[0].claim->units, 3U) << "those of the cell that has fewer";
  EXPECT_EQ(input.gates[0].verdict, Verdict::NotDemonstrated);
  // A failure in a cell with many runs is less than none in a cell with few.
  const auto other = report_of(campaign_of("claim", 60), cells, {gate(0.2, GateUnit::Run)}, [&](RunRecord& run) {
    only_the_second(run);
    if (run.cell == 0 && run.replicate == 7) samples::violate(run);
  });
  EXPECT_EQ(other.gates[0].claim->failing, 0U);
  EXPECT_EQ(other.gates[0].claim->units, 3U);
}

TEST(DistinctWorlds, OfThroughputFollowTheSameRule) {
  GateRecord fast = gate(0.1);
  fast.end_point = EndPoint::Throughput;
  fast.min_transports_per_agv_hour = 9.0;
  const auto input = report_of(campaign_of("claim", 60), grid({"sound"}, {0.4}, {2.0}), {fast}, all_alike);
  EXPECT_EQ(input.gates[0].claim->units, 1U);
}

TEST(DistinctWorlds, TablesGiveNoRateWhereEveryRunIsTheSame) {
  const auto input = report_of(campaign_of("claim", 60), grid({"sound"}, {0.0, 0.4}, {2.0}), {gate(0.1)},
                               [](RunRecord& run) { run.repeats = run.replicate > 0 && run.cell == 0; });
  const std::string text = render_text(input);
  EXPECT_THAT(text, HasSubstr("1 of 2 cells always have the same run"));
  const auto conditions = input.evidence.conditions();
  EXPECT_TRUE(is_always_the_same(conditions[0].pool.worlds));
  EXPECT_FALSE(is_always_the_same(conditions[1].pool.worlds));
}

// A file that does not say which runs repeat others: as many worlds as possible are taken out.
TEST(DistinctWorlds, UnplacedRepetitionsTakeOutAsManyWorldsAsTheyCan) {
  const auto cells = grid({"sound"}, {0.0, 0.4}, {2.0});
  Evidence evidence({campaign_of("claim", 60), cells, {gate(0.1)}});
  evidence.know_unplaced_repeats(95);
  for (std::uint64_t i = 0; i < 120; ++i) {
    RunRecord run = samples::clean_run(i, 2);
    run.factors = cells[run.cell].lowest;
    if (i == 8) samples::violate(run);
    evidence.add(run);
  }
  EXPECT_EQ(evidence.judge(0).claim->units, 60U - 47U) << "a world that repeats others takes two runs";
  EXPECT_EQ(evidence.judge(0).claim->failing, 1U);
}

// Four thousand campaigns at the limit in which a third of the worlds repeats an earlier world that passed.
TEST(DistinctWorlds, EvidenceKeepsTheRisk) {
  constexpr std::uint64_t kCampaigns = 4000, kWorlds = 80;
  CampaignRecord campaign = campaign_of("claim", kWorlds);
  campaign.required_probes.clear();
  const Evidence fresh({campaign, grid({"sound"}, {0.4}, {2.0}), {gate(0.1)}});
  std::uint64_t passed = 0;
  for (std::uint64_t c = 0; c < kCampaigns; ++c) {
    Draws draws(c, 58);
    Evidence evidence = fresh;
    bool any_passed = false, demonstrated = false;
    for (std::uint64_t i = 0; i < kWorlds && !demonstrated; ++i) {
      RunRecord run = samples::clean_run(i, 1);
      run.repeats = any_passed && synthetic::uniform(draws) < 1.0 / 3.0;
      if (!run.repeats && synthetic::uniform(draws) < 0.1) samples::violate(run);
      any_passed |= !run.outcome.violation;
      evidence.add(run);
      demonstrated = evidence.judge(0).verdict == Verdict::Demonstrated;
    }
    passed += demonstrated ? 1 : 0;
  }
  EXPECT_LE(lower_bound(passed, kCampaigns, 0.99), 0.05) << passed;
}

}  // namespace
}  // namespace fleetproof::distinct_worlds_test
