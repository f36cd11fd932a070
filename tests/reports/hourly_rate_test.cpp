// A rate of failures per AGV-hour, judged as the share of worlds that fail.
#include "reports/evidence/hourly_rate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <regex>

#include "reports/evidence/gate_bounds.hpp"
#include "reports/evidence/gate_table.hpp"
#include "reports/formats/report_formats.hpp"
#include "tests/reports/sample_campaign.hpp"
#include "tests/reports/synthetic_campaigns.hpp"

namespace fleetproof::hourly_rate_test {
namespace {

using samples::campaign_of;
using samples::grid;
using samples::report_of;
using testing::HasSubstr;
using testing::Not;

GateRecord hourly(double limit) {
  GateRecord gate;
  gate.agent = "sound";
  gate.name = "per hour";
  gate.unit = GateUnit::AgvHour;
  gate.limit = limit;
  return gate;
}

// The largest chance to pass at some number of worlds up to `most`, if each fails with this probability: every path of
// the counts, step by step. It stops where the gate passes.
double chance_to_pass(const GateTable& table, double share, std::uint64_t most) {
  std::vector<double> open{1.0};  // by failing worlds, of campaigns that have not passed
  double passed = 0.0;
  for (std::uint64_t worlds = 1; worlds <= most; ++worlds) {
    std::vector<double> next(open.size() + 1);
    for (std::size_t failing = 0; failing < open.size(); ++failing) {
      next[failing] += open[failing] * (1.0 - share);
      next[failing + 1] += open[failing] * share;
    }
    for (std::size_t failing = 0; failing < next.size(); ++failing) {
      if (passes(table, failing, worlds)) passed += std::exchange(next[failing], 0.0);
    }
    open = std::move(next);
  }
  return passed;
}

// Failures that come at the start of a run: it then has no AGV-hours, and the rate is highest for its share of worlds.
double share_at_limit(double failures_per_run) { return failures_per_run / (1.0 + failures_per_run); }

// Exactly, over all paths. Limit x AGV-hours of a run: 0.1, 1, 3.
TEST(HourlyRate, PassesSoftwareAtTheLimitNoMoreOftenThanItsRiskWhateverTheHazardIs) {
  for (const double failures_per_run : {0.1, 1.0, 3.0}) {
    for (const std::size_t cells : {1, 4}) {
      const GateCells gate_cells{cells, 0.5};
      const GateTable table = gate_table(hourly(failures_per_run / 0.5), gate_cells, 400);
      const double chance = chance_to_pass(table, share_at_limit(failures_per_run), 400);
      EXPECT_LE(chance, 0.05) << failures_per_run;
      EXPECT_GT(chance, 0.001) << "the gate can pass at all";
      EXPECT_GT(chance_to_pass(table, share_at_limit(failures_per_run / 20.0), 400), 0.9) << "good software passes";
    }
  }
}

// The order of cells, of failures within a run and of runs within a world are the same.
TEST(HourlyRate, DoesNotDependOnTheOrderOfCells) {
  const auto judged = [](std::vector<double> losses) {
    const auto cells = grid({"sound"}, losses, {2.0});
    return report_of(campaign_of("claim", 300), cells, {hourly(2.0)},
                     [&](RunRecord& run) {
                       if (run.replicate % 11 == 0 && cells[run.cell].lowest[Factor::Loss] == 0.4)
                         samples::violate(run);
                     })
        .gates[0];
  };
  const GateResult one = judged({0.0, 0.2, 0.4}), other = judged({0.4, 0.2, 0.0});
  EXPECT_EQ(one.claim->upper, other.claim->upper);
  EXPECT_EQ(one.claim->failing, 28U);
  EXPECT_EQ(one.reason, other.reason);
}

// Runs of 600 s with 5 AGVs have 5/6 AGV-hours.
TEST(HourlyRate, HasTheBoundsThatFollowFromThoseOfTheShare) {
  GateRecord world = hourly(0.1);
  world.unit = GateUnit::World;
  for (const GateMethod method : {GateMethod::AnyTime, GateMethod::Fixed}) {
    GateRecord rate = hourly(0.1);
    rate.method = world.method = method;
    const GateCells cells{4, 5.0 / 6.0};
    const RateInterval share = gate_bounds(world, 7, 200, cells), per_hour = gate_bounds(rate, 7, 200, cells);
    EXPECT_NEAR(per_hour.upper, share.upper / ((1.0 - share.upper) * 5.0 / 6.0), 1e-12);
    EXPECT_NEAR(per_hour.lower, share.lower / (4.0 * 5.0 / 6.0), 1e-12);
  }
  EXPECT_TRUE(std::isinf(gate_bounds(hourly(0.1), 3, 3, {1, 1.0}).upper));
}

TEST(HourlyRate, CountsFleetsOfDifferentSizesByTheirMean) {
  std::vector<CellRecord> cells = grid({"sound"}, {0.0, 0.4}, {2.0});
  cells[1].fleet_size = 15;
  const Evidence evidence({campaign_of("claim", 9), cells, {hourly(1.0)}});
  EXPECT_EQ(evidence.gate_cells(0).count, 2U);
  EXPECT_NEAR(evidence.gate_cells(0).run_agv_hours, 10.0 / 6.0, 1e-12);
}

TEST(HourlyRate, IsRefutedByTooManyWorldsForAllRunsTogether) {
  const auto every_world = [](RunRecord& run) {
    if (run.cell == 0) samples::violate(run);
  };
  const auto cells = grid({"sound"}, {0.4}, {2.0});
  const auto input = report_of(campaign_of("claim", 60), cells, {hourly(0.5), hourly(1.25)}, every_world);
  EXPECT_EQ(input.gates[0].verdict, Verdict::Violated) << input.gates[0].reason;
  EXPECT_EQ(input.gates[1].verdict, Verdict::NotDemonstrated) << "1.25 x 5/6 > 1: a failure in each world is allowed";
  EXPECT_FALSE(cannot_be_violated(input.evidence.gates()[0], input.evidence.gate_cells(0)));
  EXPECT_TRUE(cannot_be_violated(input.evidence.gates()[1], input.evidence.gate_cells(1)));
}

// Where all worlds may fail, a page has a sentence in place of an endless number.
TEST(HourlyRate, WithoutABoundIsASentence) {
  const auto page = [](std::uint64_t failing_worlds, double limit) {
    const auto input =
        report_of(campaign_of("claim", 20), grid({"sound"}, {0.4}, {2.0}), {hourly(limit)}, [&](RunRecord& run) {
          if (run.replicate < failing_worlds) samples::violate(run);
        });
    return std::regex_replace(find_entry(report_formats(), "text")->make(input), std::regex("\\s+"), " ");
  };
  const std::string endless = page(20, 1.25);
  EXPECT_THAT(endless,
              HasSubstr("in 20 of 20 runs (16.6667 AGV-hours); every world may fail, so that the true rate has "
                        "no upper bound (95 %)"));
  EXPECT_THAT(endless,
              HasSubstr("no upper bound] per AGV-hour, one-sided 95 % upper bound none, limit 1.25 per AGV-hour"));
  EXPECT_THAT(endless, HasSubstr("so that the rate has no upper bound, and the limit is 1.25 per AGV-hour"));
  EXPECT_THAT(endless, Not(testing::ContainsRegex("[^a-z]inf[^a-z]")));
  EXPECT_THAT(page(0, 1.25), HasSubstr("the true rate is at most "));
  EXPECT_THAT(page(19, 1.25), Not(HasSubstr("no upper bound")));
}

// Four thousand campaigns of software at the limit, whose failures come at the start of its worlds, through Evidence.
TEST(HourlyRate, EvidenceKeepsTheRisk) {
  constexpr std::uint64_t kCampaigns = 4000, kWorlds = 60;
  const auto cells = grid({"sound"}, {0.4}, {2.0});
  CampaignRecord campaign = campaign_of("claim", kWorlds);
  campaign.required_probes.clear();
  const double limit = 1.2;  // a failure per run of 5/6 AGV-hours
  const Evidence fresh({campaign, cells, {hourly(limit)}});
  std::uint64_t passed = 0;
  for (std::uint64_t c = 0; c < kCampaigns; ++c) {
    Draws draws(c, 57);
    Evidence evidence = fresh;
    for (std::uint64_t i = 0; i < kWorlds; ++i) {
      RunRecord run = samples::clean_run(i, 1);
      if (synthetic::uniform(draws) < share_at_limit(1.0)) samples::violate(run);
      evidence.add(run);
    }
    passed += evidence.judge(0).verdict == Verdict::Demonstrated ? 1 : 0;
  }
  EXPECT_LE(lower_bound(passed, kCampaigns, 0.99), 0.05) << passed;
}

}  // namespace
}  // namespace fleetproof::hourly_rate_test
