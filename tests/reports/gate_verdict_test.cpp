#include "reports/evidence/gate_verdict.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "reports/evidence/rounding.hpp"

namespace fleetproof::gate_verdict_test {
namespace {

using testing::HasSubstr;

GateRecord gate(GateKind kind, double limit) {
  GateRecord gate;
  gate.name = "safe";
  gate.agent = "sound";
  gate.kind = kind;
  gate.method = GateMethod::Fixed;
  gate.limit = limit;
  return gate;
}

GateCounts counts(std::uint64_t units, std::uint64_t failing, std::uint64_t unknown = 0) {
  GateCounts c;
  c.cells.count = c.due_cells = 12;
  c.units = c.distinct = c.counted = c.replicates = c.planned = units;
  c.failing = failing;
  c.failing_or_unknown = failing + unknown;
  c.failing_runs = failing;
  c.transports_per_agv_hour = 12.0;
  return c;
}

struct Case {
  const char* what;
  GateKind kind;
  double limit;
  std::uint64_t units, failing, unknown;
  Verdict verdict;
};

constexpr Case kCases[] = {
    {"enough runs without a failure", GateKind::None, 1e-3, 2995, 0, 0, Verdict::Demonstrated},
    {"one run too few", GateKind::None, 1e-3, 2994, 0, 0, Verdict::NotDemonstrated},
    {"one failure among very many", GateKind::None, 1e-3, 10'000'000, 1, 0, Verdict::Violated},
    {"one unknown outcome does not refute", GateKind::None, 1e-3, 2995, 0, 1, Verdict::NotDemonstrated},
    {"an unknown outcome that the bound can bear", GateKind::None, 1e-3, 4742, 0, 1, Verdict::Demonstrated},
    {"nothing run", GateKind::None, 1e-3, 0, 0, 0, Verdict::NotDemonstrated},
    {"rate: enough without a failure", GateKind::Rate, 1e-3, 2995, 0, 0, Verdict::Demonstrated},
    {"rate: one failure, enough for one", GateKind::Rate, 1e-3, 4742, 1, 0, Verdict::Demonstrated},
    {"rate: one failure, one run too few", GateKind::Rate, 1e-3, 4741, 1, 0, Verdict::NotDemonstrated},
    {"rate: failures, the interval holds the limit", GateKind::Rate, 1e-2, 200, 4, 0, Verdict::NotDemonstrated},
    {"rate: the lower bound is above the limit", GateKind::Rate, 1e-2, 200, 20, 0, Verdict::Violated},
    {"rate: every unit failed", GateKind::Rate, 0.5, 10, 10, 0, Verdict::Violated},
    {"rate: one unit, and it failed", GateKind::Rate, 0.5, 1, 1, 0, Verdict::NotDemonstrated},
    {"rate: every unit unknown", GateKind::Rate, 1e-2, 200, 0, 200, Verdict::NotDemonstrated},
    {"rate: nothing run", GateKind::Rate, 1e-3, 0, 0, 0, Verdict::NotDemonstrated},
    {"rate: a limit of zero cannot be met", GateKind::Rate, 0.0, 1000, 0, 0, Verdict::NotDemonstrated},
};

TEST(GateVerdict, follows_the_table) {
  for (const auto& c : kCases) {
    const auto result = judge_gate(gate(c.kind, c.limit), counts(c.units, c.failing, c.unknown));
    EXPECT_EQ(name_of(result.verdict), name_of(c.verdict)) << c.what << ": " << result.reason;
    EXPECT_FALSE(result.reason.empty()) << c.what;
  }
}

TEST(GateVerdict, the_words_are_fixed) {
  EXPECT_STREQ(name_of(Verdict::Demonstrated), "demonstrated");
  EXPECT_STREQ(name_of(Verdict::Violated), "violated");
  EXPECT_STREQ(name_of(Verdict::NotDemonstrated), "not demonstrated");
}

TEST(GateVerdict, the_claim_counts_unknown_outcomes_and_the_optimistic_line_does_not) {
  const auto result = judge_gate(gate(GateKind::Rate, 1e-3), counts(1000, 2, 5));
  EXPECT_EQ(result.claim->failing, 7u);
  EXPECT_EQ(result.optimistic->failing, 2u);
  EXPECT_GT(result.claim->upper, result.optimistic->upper);
  EXPECT_NEAR(result.claim->upper, upper_bound(7, 1000, 0.95), 1e-15);
  EXPECT_THAT(result.reason, HasSubstr("5 of 1000 worlds ended unknown"));
}

TEST(GateVerdict, says_how_many_more_are_needed_and_when_more_do_not_help) {
  const auto few = judge_gate(gate(GateKind::None, 1e-3), counts(200, 0));
  EXPECT_EQ(few.units_needed, 2995u);
  EXPECT_THAT(few.reason,
              HasSubstr("2995 worlds without a failure are needed, a number to be planned before the first run"));
  const auto one = judge_gate(gate(GateKind::Rate, 1e-3), counts(3000, 1));
  EXPECT_EQ(one.units_needed, 4742u);
  EXPECT_THAT(one.reason, HasSubstr("4742 worlds in all, with no failure beyond the 1 counted"));
  const auto hopeless = judge_gate(gate(GateKind::Rate, 1e-2), counts(200, 3));
  EXPECT_FALSE(hopeless.units_needed.has_value());
  EXPECT_THAT(hopeless.reason, HasSubstr("more runs will not help"));
}

TEST(GateVerdict, a_parked_fleet_demonstrates_nothing) {
  auto parked = counts(5000, 0);
  parked.transports_per_agv_hour = 0.99;
  const auto slow = judge_gate(gate(GateKind::None, 1e-3), parked);
  EXPECT_EQ(slow.verdict, Verdict::NotDemonstrated);
  EXPECT_THAT(slow.reason, HasSubstr("0.99 transports per AGV-hour, the floor is 1"));
  EXPECT_FALSE(slow.units_needed.has_value());
  parked.transports_per_agv_hour.reset();
  EXPECT_EQ(judge_gate(gate(GateKind::None, 1e-3), parked).verdict, Verdict::NotDemonstrated);
  auto idle = counts(5000, 0);
  idle.idle_cells = 1;
  EXPECT_THAT(judge_gate(gate(GateKind::None, 1e-3), idle).reason,
              HasSubstr("in 1 of 12 cells no transport was completed"));
  idle.due_cells = 3;
  EXPECT_THAT(judge_gate(gate(GateKind::None, 1e-3), idle).reason,
              HasSubstr("in 1 of 3 cells of the contract region no transport was completed"));
  auto no_floor = gate(GateKind::None, 1e-3);
  no_floor.min_transports_per_agv_hour = 0.0;
  EXPECT_EQ(judge_gate(no_floor, idle).verdict, Verdict::Demonstrated);
}

TEST(GateVerdict, a_floor_of_zero_is_no_praise_for_progress) {
  for (const double floor : {0.0, -1.0}) {
    for (const std::optional<double> rate :
         {std::optional<double>(0.0), std::optional<double>(12.0), std::optional<double>()}) {
      auto no_floor = gate(GateKind::None, 1e-3);
      no_floor.min_transports_per_agv_hour = floor;
      auto parked = counts(5000, 0);
      parked.transports_per_agv_hour = rate;
      parked.idle_cells = 12;
      const auto result = judge_gate(no_floor, parked);
      EXPECT_EQ(result.verdict, Verdict::Demonstrated);
      EXPECT_THAT(result.reason, HasSubstr("no progress was asked for"));
      EXPECT_THAT(result.reason, testing::Not(HasSubstr("made progress")));
    }
  }
}

TEST(GateVerdict, however_low_the_floor_every_cell_has_to_move) {
  auto low = gate(GateKind::None, 1e-3);
  low.min_transports_per_agv_hour = 1e-9;
  auto idle = counts(5000, 0);
  idle.idle_cells = 2;
  EXPECT_EQ(judge_gate(low, idle).verdict, Verdict::NotDemonstrated);
  EXPECT_THAT(judge_gate(low, idle).reason, HasSubstr("in 2 of 12 cells no transport was completed"));
  EXPECT_THAT(judge_gate(low, counts(5000, 0)).reason, HasSubstr("the fleet made progress (12.00"));
}

TEST(GateVerdict, a_campaign_stopped_early_demonstrates_nothing_however_good_the_bound) {
  for (const auto kind : {GateKind::None, GateKind::Rate}) {
    auto stopped = counts(4999, 0);
    stopped.planned = 5000;
    const auto result = judge_gate(gate(kind, 1e-3), stopped);
    EXPECT_EQ(result.verdict, Verdict::NotDemonstrated);
    EXPECT_EQ(result.reason,
              "stopped after 4999 of 5000 planned replicates; the bound holds only for the number fixed beforehand");
    stopped.units = stopped.replicates = 5000;
    EXPECT_EQ(judge_gate(gate(kind, 1e-3), stopped).verdict, Verdict::Demonstrated);
  }
}

TEST(GateVerdict, a_campaign_stopped_early_is_refuted_by_a_forbidden_failure_but_by_no_rate) {
  auto stopped = counts(200, 100);
  stopped.planned = 201;
  EXPECT_EQ(judge_gate(gate(GateKind::None, 1e-2), stopped).verdict, Verdict::Violated);
  const auto rate = judge_gate(gate(GateKind::Rate, 1e-2), stopped);
  EXPECT_EQ(rate.verdict, Verdict::NotDemonstrated);
  EXPECT_THAT(rate.reason, HasSubstr("stopped after 200 of 201 planned replicates"));
  EXPECT_EQ(rate.optimistic->failing, 100u);
  stopped.planned = 200;
  EXPECT_EQ(judge_gate(gate(GateKind::Rate, 1e-2), stopped).verdict, Verdict::Violated);
}

TEST(GateVerdict, a_gate_on_one_cell_counts_runs) {
  auto one = counts(100, 0);
  one.cells.count = 1;
  EXPECT_EQ(judge_gate(gate(GateKind::None, 1e-3), one).unit, "runs");
  EXPECT_EQ(judge_gate(gate(GateKind::None, 1e-3), counts(100, 0)).unit, "worlds");
}

TEST(GateVerdict, a_gate_without_cells_demonstrates_nothing) {
  GateCounts none;
  const auto result = judge_gate(gate(GateKind::None, 1e-3), none);
  EXPECT_EQ(result.verdict, Verdict::NotDemonstrated);
  EXPECT_THAT(result.reason, HasSubstr("no cell"));
}

TEST(GateVerdict, a_failure_in_an_incomplete_replicate_refutes_a_gate_that_allows_none) {
  auto early = counts(0, 0);
  early.failing_runs = 1;
  EXPECT_EQ(judge_gate(gate(GateKind::None, 1e-3), early).verdict, Verdict::Violated);
  EXPECT_EQ(judge_gate(gate(GateKind::Rate, 1e-3), early).verdict, Verdict::NotDemonstrated);
}

TEST(GateVerdict, a_search_has_no_rates) {
  auto search = counts(5000, 0);
  search.counts_only = true;
  const auto clean = judge_gate(gate(GateKind::Rate, 1e-3), search);
  EXPECT_EQ(clean.verdict, Verdict::NotDemonstrated);
  EXPECT_FALSE(clean.claim.has_value());
  search.failing = search.failing_or_unknown = search.failing_runs = 4000;
  EXPECT_EQ(judge_gate(gate(GateKind::Rate, 1e-3), search).verdict, Verdict::NotDemonstrated);
  EXPECT_EQ(judge_gate(gate(GateKind::None, 1e-3), search).verdict, Verdict::Violated);
}

TEST(Rounding, a_bound_is_never_flattered) {
  EXPECT_EQ(rounded_up(0.00100001), "0.00101");
  EXPECT_EQ(rounded_up(0.000999744), "0.001");
  EXPECT_EQ(rounded_up(0.0149), "0.0149");
  EXPECT_EQ(rounded_up(1.0), "1");
  EXPECT_EQ(rounded_up(0.0), "0");
  EXPECT_EQ(rounded_up(2.9957e-12), "3e-12");
  EXPECT_EQ(rounded_down(0.00248999), "0.00248");
  EXPECT_EQ(rounded_down(0.0), "0");
  EXPECT_EQ(rounded_rate(0.0123456), "0.0123");
}

}  // namespace
}  // namespace fleetproof::gate_verdict_test
