// Gates that hold however often one looks, and what they count.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "reports/evidence/evidence.hpp"
#include "reports/evidence/gate_bounds.hpp"
#include "reports/evidence/gate_table.hpp"
#include "reports/evidence/refutation.hpp"
#include "reports/evidence/release_gate.hpp"
#include "tests/reports/sample_campaign.hpp"

namespace fleetproof::any_time_gate_test {
namespace {

using samples::campaign_of;
using samples::grid;
using samples::report_of;
using testing::HasSubstr;

GateRecord any_time(double limit, EndPoint end_point = EndPoint::Violation, GateUnit unit = GateUnit::World) {
  GateRecord gate;
  gate.name = "any";
  gate.agent = "sound";
  gate.end_point = end_point;
  gate.unit = unit;
  gate.limit = limit;
  return gate;
}

GateRecord with_table(GateRecord gate, const GateTable& table) {
  gate.table = table;
  return gate;
}

// (1/3) sum of the likelihood ratios of 0, limit / 10 and limit / 3 against `limit`, in plain words.
double e_value(std::uint64_t failing, std::uint64_t units, double limit) {
  double sum = failing == 0 ? std::pow(1.0 - limit, -static_cast<double>(units)) : 0.0;
  for (const double q : {limit / 10.0, limit / 3.0}) {
    sum += std::pow(q / limit, static_cast<double>(failing)) *
           std::pow((1.0 - q) / (1.0 - limit), static_cast<double>(units - failing));
  }
  return sum / 3.0;
}

TEST(AnyTimeGate, PassesAtTheFirstNumberAtWhichTheEvidenceIsTwentyfold) {
  const GateTable table = gate_table(any_time(0.1), {4}, 40);
  for (std::uint64_t failing = 0; failing < 4; ++failing) {
    std::uint64_t first = failing;
    while (e_value(failing, first, 0.1) < 20.0) ++first;
    EXPECT_EQ(table.passes_from[failing], first);
    EXPECT_TRUE(passes(table, failing, first));
    EXPECT_FALSE(passes(table, failing, first - 1));
  }
}

// The table of 20 planned worlds ends early. Beyond it, the evidence is looked at in logarithms: it is too great.
TEST(AnyTimeGate, PassesBeyondItsTableToo) {
  const GateTable table = gate_table(any_time(0.1), {1}, 20);
  const std::uint64_t last = table.passes_from.size() - 1;
  ASSERT_LT(last, 100U);
  std::uint64_t before = table.passes_from[last];
  for (std::uint64_t failing = last + 1; failing < 40 * last; failing += 7) {
    const std::uint64_t units = passes_from(table, failing).value();
    EXPECT_GE(log_e_values(failing, units, 0.1).gate, std::log(20.0)) << failing << " of " << units;
    EXPECT_TRUE(passes(table, failing, units));
    EXPECT_FALSE(passes(table, failing, units - 1));
    EXPECT_GT(units, before);
    EXPECT_EQ(units_to_pass(with_table(any_time(0.1), table), failing, 1), units);
    before = units;
  }
  EXPECT_TRUE(passes(table, 300, 10'000)) << "as `fleetproof evidence release-gate` says";
  EXPECT_FALSE(passes(gate_table(any_time(1e-12), {1}, 20), 1, 1'000'000))
      << "a table of one row says nothing of others";
}

TEST(AnyTimeGate, ItsBoundIsTheLimitThatItWouldJustPass) {
  for (const std::uint64_t failing : {0U, 1U, 3U}) {
    const double upper = gate_bounds(any_time(0.1), failing, 200).upper;
    EXPECT_NEAR(e_value(failing, 200, upper), 20.0, 1e-6);
    EXPECT_LT(gate_interval_95(any_time(0.1), failing, 200).lower, static_cast<double>(failing) / 200.0 + 1e-12);
    EXPECT_GT(gate_interval_95(any_time(0.1), failing, 200).upper, upper) << "half of the risk on each side";
  }
  EXPECT_EQ(gate_bounds(any_time(0.1), 0, 0).upper, 1.0);
  EXPECT_EQ(gate_bounds(any_time(0.1), 5, 5).upper, 1.0);
}

// The mean likelihood ratio of odds that are 2, 5 and 20 times those of the limit, in plain words.
double refutation(std::uint64_t failing, std::uint64_t units, double limit) {
  double sum = 0.0;
  for (const double times : {2.0, 5.0, 20.0}) {
    const double odds = times * limit / (1.0 - limit), q = odds / (1.0 + odds);
    sum += std::pow(q / limit, static_cast<double>(failing)) *
           std::pow((1.0 - q) / (1.0 - limit), static_cast<double>(units - failing));
  }
  return sum / 3.0;
}

TEST(AnyTimeGate, IsRefutedWhileTheEvidenceAgainstItsLimitIsTwentyfold) {
  const GateTable table = gate_table(any_time(0.1), {4}, 40);
  for (std::uint64_t failing = 1; failing < 12; ++failing) {
    for (std::uint64_t units = failing; units < 120; ++units) {
      EXPECT_EQ(refutes(table, failing, units), refutation(failing, units, 0.1) >= 20.0) << failing << " of " << units;
      EXPECT_EQ(refutes(table, failing, units), gate_bounds(any_time(0.1), failing, units).lower > 0.1);
    }
  }
  EXPECT_FALSE(refutes(table, 0, 1));
  EXPECT_TRUE(refutes(table, 10, 30)) << "ten of thirty worlds deadlock";
}

// Far more failures than the table has. The evidence is looked at in logarithms: as a number it is too great.
TEST(AnyTimeGate, IsRefutedBeyondItsTable) {
  const GateTable table = gate_table(any_time(0.2), {1}, 20);
  const std::uint64_t last = table.refuted_up_to.size() - 1;
  ASSERT_LT(last, 300U);
  EXPECT_TRUE(refutes(table, 3023, 4000));
  EXPECT_FALSE(refutes(table, 700, 4000)) << "fewer than the limit allows";
  for (std::uint64_t failing = last + 1; failing < 40 * last; failing += 17) {
    std::uint64_t most = failing;
    while (refutes(table, failing, most + 1)) ++most;
    EXPECT_GE(log_refutation(failing, most, 0.2), std::log(20.0)) << failing << " of " << most;
    EXPECT_LT(log_refutation(failing, most + most / 5, 0.2), std::log(20.0)) << "a fifth more could not be refuted";
  }
}

TEST(AnyTimeGate, SaysWhatAStoppedNightCarries) {
  const auto stopped =
      report_of(campaign_of("claim", 1000), grid({"sound"}, {0.0, 0.4}, {2.0}), {any_time(0.1)}, {}, 0, 2 * 900);
  ASSERT_EQ(stopped.evidence.complete_replicates(), 100U);
  EXPECT_EQ(stopped.gates[0].verdict, Verdict::Demonstrated) << stopped.gates[0].reason;
  const auto early =
      report_of(campaign_of("claim", 1000), grid({"sound"}, {0.0, 0.4}, {2.0}), {any_time(0.1)}, {}, 0, 2 * 980);
  EXPECT_EQ(early.gates[0].verdict, Verdict::NotDemonstrated);
  EXPECT_THAT(early.gates[0].reason, HasSubstr("32 worlds without a failure are needed (12 more)"));
}

// Counts up, world by world, with as many failures as the rate brings.
std::optional<std::uint64_t> first_pass(const GateTable& table, std::uint64_t failing, std::uint64_t units) {
  for (std::uint64_t n = units; n < 5000; ++n) {
    if (passes(table, (failing * n + units - 1) / units, n)) return n;
  }
  return std::nullopt;
}

TEST(AnyTimeGate, SaysWhatHelpsIfFailuresGoOn) {
  GateRecord gate = any_time(0.1);
  gate.table = gate_table(gate, {4}, 1000);
  for (const auto& [failing, units] : {std::pair(1U, 40U), {1U, 60U}, {2U, 100U}, {3U, 90U}, {5U, 100U}, {10U, 150U}})
    EXPECT_EQ(units_to_pass_at_this_rate(gate, failing, units), first_pass(gate.table, failing, units))
        << failing << " of " << units;
  const auto reason_with = [&](unsigned failing) {
    return report_of(campaign_of("claim", 150), grid({"sound"}, {0.0, 0.4}, {2.0}), {gate},
                     [&](RunRecord& run) {
                       if (run.cell == 0 && run.replicate < failing) run.outcome.crash = true;
                     })
        .gates[0]
        .reason;
  };
  EXPECT_THAT(reason_with(10), HasSubstr("10 counted, are needed (72 more); if failures go on as they were seen, more "
                                         "runs will not help"));
  EXPECT_THAT(reason_with(7), HasSubstr("if failures go on as they were seen, about"));
  EXPECT_THAT(reason_with(40), HasSubstr("more runs will not help"));
}

TEST(AnyTimeGate, OfRunsIsDecidedByTheWorstCell) {
  const auto cells = grid({"sound"}, {0.0, 0.4}, {2.0});
  const auto input = report_of(campaign_of("claim", 60), cells, {any_time(0.1, EndPoint::Violation, GateUnit::Run)},
                               [](RunRecord& run) {
                                 if (run.cell == 1 && run.replicate < 3) samples::violate(run);
                                 if (run.cell == 0 && run.replicate == 7) samples::violate(run);
                               });
  EXPECT_EQ(input.gates[0].claim->failing, 3U);
  EXPECT_EQ(input.gates[0].claim->units, 60U);
  EXPECT_EQ(input.gates[0].unit, "runs");
  EXPECT_GT(gate_table(any_time(0.1), {1}, 60).refuted_up_to[5],
            gate_table(any_time(0.1, EndPoint::Violation, GateUnit::Run), {2}, 60).refuted_up_to[5])
      << "two cells share the risk of a wrong refutation";
}

// 100 cells are the same, and the worst of them is looked at: 11 of 60 are no rare worst of 100.
TEST(AnyTimeGate, OfAFixedPlanTheCellsShareTheRiskOfARefutationToo) {
  const auto verdict = [](std::size_t cells) {
    std::vector<double> losses;
    for (std::size_t i = 0; i < cells; ++i) losses.push_back(0.4 * static_cast<double>(i) / 100.0);
    GateRecord gate = any_time(0.1, EndPoint::Violation, GateUnit::Run);
    gate.method = GateMethod::Fixed;
    return report_of(campaign_of("claim", 60), grid({"sound"}, losses, {2.0}), {gate},
                     [](RunRecord& run) {
                       if (run.cell == 0 && run.replicate < 11) samples::violate(run);
                     })
        .gates[0]
        .verdict;
  };
  EXPECT_EQ(verdict(1), Verdict::Violated);
  EXPECT_EQ(verdict(100), Verdict::NotDemonstrated);
}

TEST(AnyTimeGate, OnThroughputFailsAWorldThatIsTooSlowOverItsCells) {
  const auto cells = grid({"sound"}, {0.0, 0.4}, {2.0});
  GateRecord gate = any_time(0.1, EndPoint::Throughput);
  gate.min_transports_per_agv_hour = 9.0;  // the sample has 12 in each cell
  const auto slow_cell = [](RunRecord& run) {
    if (run.cell == 1) run.outcome.counters.transports_done = 6;
  };
  EXPECT_EQ(report_of(campaign_of("claim", 60), cells, {gate}, slow_cell).gates[0].verdict, Verdict::Demonstrated);
  const auto slow_world = [](RunRecord& run) { run.outcome.counters.transports_done = 7; };
  EXPECT_EQ(report_of(campaign_of("claim", 60), cells, {gate}, slow_world).gates[0].verdict, Verdict::Violated);
  gate.unit = GateUnit::Run;
  EXPECT_EQ(report_of(campaign_of("claim", 60), cells, {gate}, slow_cell).gates[0].verdict, Verdict::Violated);
}

TEST(AnyTimeGate, OfAReferenceAgentIsToldAndDoesNotDecide) {
  GateRecord none = any_time(0.1);
  none.decides = false;
  const auto input =
      report_of(campaign_of("claim", 60), grid({"sound"}, {0.4}, {2.0}), {none, any_time(0.1)}, [](RunRecord&) {});
  EXPECT_EQ(overall_verdict(input.evidence, input.gates), Verdict::Demonstrated);
  const auto failing = report_of(campaign_of("claim", 60), grid({"sound"}, {0.4}, {2.0}), {none},
                                 [](RunRecord& run) { samples::violate(run); });
  EXPECT_EQ(failing.gates[0].verdict, Verdict::Violated);
  EXPECT_EQ(overall_verdict(failing.evidence, failing.gates), Verdict::NotDemonstrated);
}

TEST(AnyTimeGate, ALayoutOfItsOwnHasItsOwnCells) {
  GateRecord gate = any_time(0.1);
  gate.where.layout = "hall";
  const auto input = report_of(campaign_of("claim", 4), grid({"sound"}, {0.4}, {2.0}, {"ring", "hall"}), {gate});
  EXPECT_EQ(input.gates[0].counts.cells.count, 1U);
}

// Worlds fail in the cell of 40 % and 2 s alone: a gate on that cell counts them, a gate on its neighbour none.
TEST(AnyTimeGate, AGateOnOneCellCountsItsRunsAlone) {
  GateRecord failing = any_time(0.1), clean = any_time(0.1);
  for (GateRecord* gate : {&failing, &clean}) gate->where.factors[Factor::Loss] = 0.4;
  failing.where.factors[Factor::Delay] = 2.0;
  clean.where.factors[Factor::Delay] = 1.0;
  const auto input = report_of(campaign_of("claim", 60), grid({"sound"}, {0.0, 0.4}, {1.0, 2.0}), {failing, clean},
                               [](RunRecord& run) {
                                 if (run.cell == 3 && run.replicate < 40) samples::violate(run);
                               });
  EXPECT_EQ(input.gates[0].claim->failing, 40U);
  EXPECT_EQ(input.gates[0].claim->units, 60U);
  EXPECT_EQ(input.gates[0].unit, "runs");
  EXPECT_EQ(input.gates[0].verdict, Verdict::Violated);
  EXPECT_EQ(input.gates[1].claim->failing, 0U);
  EXPECT_EQ(input.gates[1].verdict, Verdict::Demonstrated);
}

}  // namespace
}  // namespace fleetproof::any_time_gate_test
