#include "reports/evidence/evidence.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "tests/reports/sample_campaign.hpp"

namespace fleetproof::evidence_test {
namespace {

using samples::campaign_of;
using samples::gate_of;
using samples::grid;
using samples::report_of;

TEST(Evidence, a_pooled_gate_counts_replicates_not_runs) {
  // Replicate 3 fails in all its six cells: that is one failure, not six.
  const auto input = report_of(campaign_of("claim", 10), grid({"sound"}, {0.0, 0.4}, {0.0, 1.0, 2.0}),
                               {gate_of("sound", GateKind::Rate, Region::Contract, 1e-3)}, [](RunRecord& run) {
                                 if (run.replicate == 3) samples::violate(run);
                               });
  const auto& gate = input.gates[0];
  EXPECT_EQ(gate.unit, "worlds");
  EXPECT_EQ(gate.claim->units, 10u);
  EXPECT_EQ(gate.claim->failing, 1u);
  EXPECT_EQ(gate.counts.failing_runs, 6u);
}

TEST(Evidence, a_gate_sees_its_own_agent_and_region_only) {
  const auto cells = grid({"sound", "faulty"}, {0.0, 0.4, 0.8}, {0.0, 2.0, 5.0});
  const std::vector<GateRecord> gates{gate_of("sound", GateKind::None, Region::Contract, 1e-3),
                                      gate_of("sound", GateKind::None, Region::WorstCase, 1e-3),
                                      gate_of("sound", GateKind::None, Region::All, 1e-3),
                                      gate_of("faulty", GateKind::None, Region::Contract, 1e-3)};
  const auto input = report_of(campaign_of("claim", 2), cells, gates, [&](RunRecord& run) {
    const auto& cell = cells[run.cell];
    if (cell.agent == "faulty" || cell.lowest[Factor::Delay] == 5.0) samples::violate(run);
  });
  EXPECT_EQ(input.gates[0].verdict, Verdict::NotDemonstrated);
  EXPECT_EQ(input.gates[0].counts.cells.count, 4u);
  EXPECT_EQ(input.gates[1].counts.cells.count, 1u);
  EXPECT_EQ(input.gates[1].unit, "runs");
  EXPECT_EQ(input.gates[1].claim->units, 2u);
  EXPECT_EQ(input.gates[2].verdict, Verdict::Violated);
  EXPECT_EQ(input.gates[2].counts.failing_runs, 6u);
  EXPECT_EQ(input.gates[3].verdict, Verdict::Violated);
}

TEST(Evidence, an_incomplete_replicate_is_not_counted_but_its_failures_are_remembered) {
  const auto cells = grid({"sound"}, {0.0, 0.4}, {2.0});
  const std::vector<GateRecord> gates{gate_of("sound", GateKind::Rate, Region::Contract, 1e-3),
                                      gate_of("sound", GateKind::None, Region::Contract, 1e-3)};
  const auto input = report_of(
      campaign_of("claim", 4), cells, gates,
      [](RunRecord& run) {
        if (run.run_index == 8) samples::violate(run);
      },
      1);
  EXPECT_EQ(input.evidence.runs(), 9u);
  EXPECT_EQ(input.evidence.complete_replicates(), 4u);
  EXPECT_EQ(input.evidence.tally(0).runs, 4u);
  EXPECT_EQ(input.evidence.tally(0).violating_runs, 0u);
  EXPECT_EQ(input.gates[0].claim->failing, 0u);
  EXPECT_EQ(input.gates[0].verdict, Verdict::NotDemonstrated);
  EXPECT_EQ(input.gates[1].verdict, Verdict::Violated);
  EXPECT_EQ(input.gates[1].worst->run_index, 8u);
}

TEST(Evidence, runs_come_in_order_without_gaps) {
  const auto cells = grid({"sound"}, {0.0}, {0.0, 2.0});
  Evidence evidence({campaign_of("claim", 2), cells, {}});
  evidence.add(samples::clean_run(0, 2));
  EXPECT_THROW(evidence.add(samples::clean_run(2, 2)), InvariantViolation);
  EXPECT_THROW(evidence.add(samples::clean_run(0, 2)), InvariantViolation);
  EXPECT_NO_THROW(evidence.add(samples::clean_run(1, 2)));
}

TEST(Evidence, tallies_every_end_point_by_itself) {
  const auto input = report_of(campaign_of("claim", 8), grid({"sound"}, {0.4}, {2.0}), {}, [](RunRecord& run) {
    auto& o = run.outcome;
    if (run.run_index == 1) samples::violate(run, 60'000);
    if (run.run_index == 2) samples::violate(run, -5'000, true);
    if (run.run_index == 3) o.stuck = true;
    if (run.run_index == 4) o.crash = true;
    if (run.run_index == 5) o.hang = true;
    if (run.run_index == 6) o.indeterminate = true;
    if (run.run_index == 7) {
      samples::violate(run, 90'000);
      o.crash = true;
    }
  });
  const auto& tally = input.evidence.tally(0);
  EXPECT_EQ(tally.runs, 8u);
  EXPECT_EQ(tally.violating_runs, 3u);
  EXPECT_EQ(tally.contact_runs, 1u);
  EXPECT_EQ(tally.stuck_runs, 1u);
  EXPECT_EQ(tally.crash_runs, 2u);
  EXPECT_EQ(tally.hang_runs, 1u);
  EXPECT_EQ(tally.indeterminate_runs, 1u);
  EXPECT_EQ(tally.unknown_runs, 3u);  // the run that violated before it crashed is known
  EXPECT_EQ(tally.min_clearance_um, -5'000);
  EXPECT_EQ(tally.transports_done, 80u);
  EXPECT_NEAR(tally.agv_hours(), 8 * 5 * 600.0 / 3600.0, 1e-9);
  EXPECT_NEAR(*tally.transports_per_agv_hour(), 12.0, 1e-9);
}

TEST(Evidence, a_contact_gate_forgives_a_violation_but_not_a_crash_after_it) {
  auto gate = gate_of("sound", GateKind::Rate, Region::WorstCase, 1e-2);
  gate.end_point = EndPoint::Contact;
  const auto input = report_of(campaign_of("claim", 10), grid({"sound"}, {0.4}, {2.0}), {gate}, [](RunRecord& run) {
    if (run.run_index < 3) samples::violate(run);
    if (run.run_index == 2) run.outcome.crash = true;
  });
  EXPECT_EQ(input.gates[0].optimistic->failing, 0u);
  EXPECT_EQ(input.gates[0].claim->failing, 1u);
}

TEST(Evidence, outside_the_contract_standing_still_is_legal) {
  const auto cells = grid({"sound"}, {0.0, 0.9}, {0.0});
  const auto park_outside = [](RunRecord& run) {
    if (run.cell == 1) run.outcome.counters.transports_done = 0;
  };
  EXPECT_EQ(
      report_of(campaign_of("claim", 3000), cells, {gate_of("sound", GateKind::None, Region::All, 1e-3)}, park_outside)
          .gates[0]
          .verdict,
      Verdict::Demonstrated);
  const auto park_inside = [](RunRecord& run) {
    if (run.cell == 0) run.outcome.counters.transports_done = 0;
  };
  EXPECT_EQ(
      report_of(campaign_of("claim", 3000), cells, {gate_of("sound", GateKind::None, Region::All, 1e-3)}, park_inside)
          .gates[0]
          .verdict,
      Verdict::NotDemonstrated);
}

TEST(Evidence, a_gate_with_cells_outside_the_contract_only_asks_for_progress_there) {
  const auto cells = grid({"sound"}, {0.8, 0.9}, {0.0});
  const auto verdict = [&](std::uint64_t done) {
    return report_of(campaign_of("claim", 3000), cells, {gate_of("sound", GateKind::None, Region::All, 1e-3)},
                     [&](RunRecord& run) { run.outcome.counters.transports_done = done; })
        .gates[0]
        .verdict;
  };
  EXPECT_EQ(verdict(10), Verdict::Demonstrated);
  EXPECT_EQ(verdict(0), Verdict::NotDemonstrated);
}

TEST(Evidence, conditions_pool_layouts_by_replicate) {
  const auto cells = grid({"sound"}, {0.4}, {2.0, 5.0}, {"ring", "cross"});
  const auto input = report_of(campaign_of("claim", 5), cells, {}, [](RunRecord& run) {
    if (run.replicate == 1 && run.cell % 2 == 0) samples::violate(run);  // both layouts at 2 s
  });
  const auto conditions = input.evidence.conditions();
  ASSERT_EQ(conditions.size(), 2u);
  EXPECT_TRUE(conditions[0].is_worst_case);
  EXPECT_EQ(conditions[0].tally.runs, 10u);
  EXPECT_EQ(conditions[0].tally.violating_runs, 2u);
  EXPECT_EQ(conditions[0].pool.worlds.units, 5u);
  EXPECT_EQ(conditions[0].pool.worlds.failing, 1u);
  EXPECT_FALSE(conditions[1].in_contract);
  EXPECT_EQ(conditions[1].pool.worlds.failing, 0u);
}

TEST(Evidence, worst_runs_are_sorted_by_what_happened_then_by_clearance) {
  const auto input = report_of(campaign_of("claim", 40), grid({"sound"}, {0.4}, {2.0}), {}, [](RunRecord& run) {
    auto& o = run.outcome;
    switch (run.run_index) {
      case 2:
        o.stuck = true;
        break;
      case 4:
        o.hang = true;
        break;
      case 6:
        o.crash = true;
        break;
      case 8:
        samples::violate(run, 90'000);
        break;
      case 10:
        samples::violate(run, 20'000);
        break;
      case 12:
        samples::violate(run, -1'000, true);
        break;
      case 14:
        samples::violate(run, 20'000);
        break;
      default:
        break;
    }
  });
  std::vector<std::uint64_t> order;
  for (const auto& run : input.evidence.worst_runs(true)) order.push_back(run.run_index);
  EXPECT_THAT(order, testing::ElementsAre(12, 10, 14, 8, 6, 4, 2));
  EXPECT_TRUE(input.evidence.worst_runs(false).empty());
}

TEST(Evidence, keeps_only_the_worst_few) {
  const auto input = report_of(campaign_of("claim", 200), grid({"sound"}, {0.4}, {2.0}), {}, [](RunRecord& run) {
    samples::violate(run, 100'000 - static_cast<std::int64_t>(run.run_index));
  });
  const auto& worst = input.evidence.worst_runs(true);
  ASSERT_EQ(worst.size(), Evidence::kWorstRuns);
  EXPECT_EQ(worst.front().run_index, 199u);
  EXPECT_EQ(worst.back().run_index, 190u);
}

TEST(Conclusion, engine_error_before_violated_before_not_demonstrated) {
  const auto cells = grid({"sound"}, {0.4}, {2.0});
  const auto gate = gate_of("sound", GateKind::None, Region::WorstCase, 1e-3);
  const auto code = [&](std::uint64_t replicates, const samples::Change& change) {
    return conclusion_of(report_of(campaign_of("claim", replicates), cells, {gate}, change));
  };
  EXPECT_EQ(code(2995, {}), Conclusion::Demonstrated);
  EXPECT_EQ(code(100, {}), Conclusion::NotDemonstrated);
  EXPECT_EQ(code(0, {}), Conclusion::NotDemonstrated);
  EXPECT_EQ(code(100,
                 [](RunRecord& run) {
                   if (run.run_index == 7) samples::violate(run);
                 }),
            Conclusion::Violated);
  EXPECT_EQ(code(100,
                 [](RunRecord& run) {
                   if (run.run_index == 7) samples::violate(run);
                   if (run.run_index == 9) run.outcome.engine_error = true;
                 }),
            Conclusion::EngineFault);
  EXPECT_EQ(conclusion_of(report_of(campaign_of("claim", 3000), cells, {})), Conclusion::NotDemonstrated);
}

TEST(Conclusion, a_campaign_that_is_not_complete_is_not_demonstrated) {
  const auto cells = grid({"sound"}, {0.0, 0.4}, {2.0});
  const auto gate = gate_of("sound", GateKind::None, Region::Contract, 1e-3);
  const auto whole = report_of(campaign_of("claim", 3001), cells, {gate});
  EXPECT_TRUE(whole.evidence.complete());
  EXPECT_EQ(conclusion_of(whole), Conclusion::Demonstrated);
  const auto stopped = report_of(campaign_of("claim", 3001), cells, {gate}, {}, 0, 1);
  EXPECT_FALSE(stopped.evidence.complete());
  EXPECT_EQ(stopped.gates[0].counts.planned, 3001u);
  EXPECT_EQ(stopped.gates[0].counts.units, 3000u);
  EXPECT_EQ(conclusion_of(stopped), Conclusion::NotDemonstrated);
  const auto refuted = report_of(
      campaign_of("claim", 3001), cells, {gate},
      [](RunRecord& run) {
        if (run.run_index == 6000) samples::violate(run);
      },
      0, 1);
  EXPECT_EQ(conclusion_of(refuted), Conclusion::Violated);
}

TEST(Conclusion, one_violated_gate_outweighs_many_demonstrated_ones) {
  const auto cells = grid({"sound", "faulty"}, {0.4}, {2.0});
  const auto input = report_of(campaign_of("claim", 3000), cells,
                               {gate_of("sound", GateKind::None, Region::WorstCase, 1e-3),
                                gate_of("faulty", GateKind::None, Region::WorstCase, 1e-3)},
                               [](RunRecord& run) {
                                 if (run.cell == 1) samples::violate(run);
                               });
  EXPECT_EQ(input.gates[0].verdict, Verdict::Demonstrated);
  EXPECT_EQ(input.gates[1].verdict, Verdict::Violated);
  EXPECT_EQ(conclusion_of(input), Conclusion::Violated);
}

}  // namespace
}  // namespace fleetproof::evidence_test
