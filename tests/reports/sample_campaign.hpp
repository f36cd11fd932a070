#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "reports/sections/report_input.hpp"
#include "tests/support/at_seconds.hpp"

namespace fleetproof::samples {

inline CampaignRecord campaign_of(std::string kind, std::uint64_t replicates) {
  CampaignRecord record;
  record.name = "nightly";
  record.kind = std::move(kind);
  record.seed = 42;
  record.replicates = replicates;
  record.plan_hash = 0xabcULL;
  record.horizon_s = 600.0;
  record.engine = {"0.1.0", "f00d", "g++ 12.2.0", "-O2 -ffp-contract=off", "SQLite 3.40.1"};
  if (record.kind == "claim") record.required_probes = {"encounter", "negotiation?"};
  return record;
}

// agents x layouts x losses x delays, fleets of 5.
inline std::vector<CellRecord> grid(const std::vector<std::string>& agents, const std::vector<double>& losses,
                                    const std::vector<double>& delays_s,
                                    const std::vector<std::string>& layouts = {"ring"}) {
  std::vector<CellRecord> cells;
  for (const auto& agent : agents) {
    for (const auto& layout : layouts) {
      for (const double loss : losses) {
        for (const double delay_s : delays_s)
          cells.push_back({static_cast<std::uint32_t>(cells.size()), agent, layout, 5, {loss, delay_s}});
      }
    }
  }
  return cells;
}

inline GateRecord gate_of(std::string agent, GateKind kind, Region region, double limit, double floor = 1.0) {
  GateRecord gate;
  gate.name = "safe";
  gate.agent = std::move(agent);
  gate.kind = kind;
  gate.region = region;
  gate.method = GateMethod::Fixed;
  gate.limit = limit;
  gate.min_transports_per_agv_hour = floor;
  return gate;
}

// 600 s with 5 AGVs and ten transports: 12 per AGV-hour.
inline RunRecord clean_run(std::uint64_t run_index, std::size_t cells) {
  RunRecord run;
  run.run_index = run_index;
  run.cell = static_cast<std::uint32_t>(run_index % cells);
  run.replicate = run_index / cells;
  run.outcome.simulated_ns = 600'000'000'000;
  run.outcome.agv_count = 5;
  run.outcome.counters.transports_done = 10;
  run.outcome.counters.messages_sent = 40;
  file_probes(run.outcome, {{ProbeSource::World, "crossing", 4},
                            {ProbeSource::World, "head-on", 2},
                            {ProbeSource::Agent, "negotiation", 30}});
  return run;
}

inline void violate(RunRecord& run, std::int64_t clearance_um = 70'000, bool contact = false) {
  Violation violation;
  violation.a = EntityId{1u};
  violation.b = EntityId{3u};
  violation.first = at_seconds(12.3);
  violation.closest_at = at_seconds(12.345);
  violation.min_clearance_um = clearance_um;
  violation.contact = contact;
  file_violations(run.outcome, {violation});
}

// A run that was simulated once more and came out the same, or in another way that was judged alike.
inline AuditedRun audit_of(std::uint64_t run_index, bool same, JudgedOutcome judged = {}) {
  AuditedOutcome outcome;
  outcome.judged = judged;
  outcome.simulated_ns = 600'000'000'000;
  outcome.agv_count = 5;
  outcome.transports_done = 10;
  return {{run_index, same ? 1U : 2U, outcome}, same};
}

using Change = std::function<void(RunRecord&)>;

inline constexpr int kExitCode = 17;  // of no verdict: reports repeat what the program says

// The judged evidence of all planned replicates, each run changed by `change`.
inline ReportInput report_of(CampaignRecord campaign, const std::vector<CellRecord>& cells,
                             const std::vector<GateRecord>& gates, const Change& change = {},
                             std::uint64_t extra_runs = 0, std::uint64_t missing_runs = 0,
                             const std::vector<AuditedRun>& audits = {}) {
  const StoredPlan plan{campaign, cells, gates};
  ReportInput input{"night.fp", campaign, Evidence(plan), Breakdown(plan), {}, {}, 0};
  for (const AuditedRun& audit : audits) input.evidence.know(audit);
  for (std::uint64_t i = 0; i < campaign.replicates * cells.size() + extra_runs - missing_runs; ++i) {
    auto run = clean_run(i, cells.size());
    run.factors = cells[run.cell].lowest;
    if (change) change(run);
    input.evidence.add(run);
    input.breakdown.add(run);
    input.failures.add(run, cells[run.cell].agent);
    ++input.stored_runs;
  }
  input.gates = input.evidence.judge_all();
  input.exit_code = kExitCode;
  return input;
}

}  // namespace fleetproof::samples
