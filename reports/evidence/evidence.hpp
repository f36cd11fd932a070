#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "reports/evidence/coverage.hpp"
#include "reports/evidence/failing_run.hpp"
#include "reports/evidence/gate_verdict.hpp"
#include "reports/evidence/pool.hpp"
#include "reports/evidence/tally.hpp"
#include "storage/records.hpp"

namespace fleetproof {

// All cells of one agent at the same factors, or between the same bounds. It is one row of a table.
struct Condition {
  std::string agent;
  FactorValues lowest, highest;  // equal, unless each replicate draws its values between them
  bool in_contract = false, is_worst_case = false;
  Tally tally;
  Pool pool;
  std::optional<FailingRun> worst;  // the most serious run with a violation or an unknown end
};

// Some runs of one agent, and the most serious of them.
struct AgentRuns {
  std::string agent;
  std::uint64_t runs = 0;
  FailingRun worst;
};

// What the runs of one agent met, what they should have met and did not, and the incidents that the laws found.
struct AgentCoverage {
  std::string agent;
  Coverage coverage;
  std::vector<MissingProbe> missing;
  std::map<IncidentKind, IncidentTally> incidents;
};

// Counts the runs of a campaign, in order of run index, without gaps. Only complete replicates count, so that every
// cell has the same weight. The failures of an incomplete replicate are still stored as failures. A report judges with
// this class, and so must any rule that stops a campaign because of its results. Threads: one.
class Evidence {
 public:
  static constexpr std::size_t kWorstRuns = 10;

  explicit Evidence(const StoredPlan& plan);

  // Adds the next run. Requires: its run_index == runs().
  void add(const RunRecord& run);
  // Instead, for whole replicates. Requires: quiet_counts().
  void add(const QuietReplicates& quiet);
  // Whether it is enough to know many quiet runs together: no gate asks whether a single one was slow.
  bool quiet_counts() const;
  // What folded runs of the cell met. Requires: they belong to complete replicates.
  void add_met(std::uint32_t cell, const std::vector<MetTotal>& met);

  bool counts_only() const { return counts_only_; }  // a campaign of kind "search"
  std::uint64_t runs() const { return runs_; }       // read so far
  std::uint64_t complete_replicates() const { return replicates_; }
  std::uint64_t planned_replicates() const { return planned_; }
  bool complete() const { return replicates_ >= planned_; }       // every planned replicate is complete
  std::uint64_t engine_errors() const { return engine_errors_; }  // among the runs read so far
  const std::string& sampling() const { return sampling_; }       // of cells with bounds; empty if there is none
  const std::vector<std::string>& held_streams() const { return held_streams_; }
  std::uint64_t held_replicate() const { return held_replicate_; }
  const std::vector<CellRecord>& cells() const { return cells_; }
  const std::vector<GateRecord>& gates() const { return gates_; }
  const Tally& tally(std::uint32_t cell) const { return tallies_.at(cell); }
  const std::vector<std::uint32_t>& cells_of(std::size_t gate) const { return pools_.at(gate).pool().cells; }

  GateResult judge(std::size_t gate) const;
  std::vector<GateResult> judge_all() const;

  std::vector<Condition> conditions() const;          // in the order of the campaign's agents, then by factors
  std::vector<AgentCoverage> agent_coverage() const;  // in the order of the campaign's agents
  // Runs within the contract region, by the factors of the run itself, in the order of the campaign's agents; only
  // agents that have such runs. The first: the software broke the safety distance. The second: AGVs came too close to
  // foreign bodies only (foreign_bodies.hpp).
  std::vector<AgentRuns> contract_failures() const { return in_order(contract_failures_); }
  std::vector<AgentRuns> foreign_body_runs() const { return in_order(foreign_body_runs_); }
  const std::vector<FailingRun>& worst_runs(bool in_contract) const {
    return (in_contract ? worst_inside_ : worst_outside_).list();
  }

 private:
  using RunsByAgent = std::map<std::string, AgentRuns>;
  void add_to(RunsByAgent& runs, const FailingRun& run) const;
  std::vector<AgentRuns> in_order(const RunsByAgent& runs) const;
  void add_to_pool(std::size_t index, const RunRecord& run, RunResult violation);
  std::optional<FailingRun> worst_of(std::size_t pool) const;  // that failed; else that stayed unknown
  void add_incidents(const RunRecord& run);
  void finish_replicate();

  bool counts_only_ = false;
  std::uint64_t planned_ = 0;
  std::string sampling_;
  std::vector<std::string> held_streams_;
  std::uint64_t held_replicate_ = 0;
  std::vector<CellRecord> cells_;
  std::vector<GateRecord> gates_;
  std::uint64_t runs_ = 0, replicates_ = 0, engine_errors_ = 0;
  std::vector<Tally> tallies_, pending_tallies_;  // by cell
  std::vector<PoolCounter> pools_;                // one for each gate, then one for each condition
  std::vector<std::vector<std::size_t>> pools_of_cell_;
  std::vector<WorstRuns> worst_of_pool_;               // that failed, in the same order
  std::vector<WorstRuns> worst_unknown_of_pool_;       // of unknown outcome
  std::vector<Coverage> coverage_, pending_coverage_;  // in the same order
  std::vector<std::string> required_probes_;
  std::map<std::string, std::map<IncidentKind, IncidentTally>> incidents_;  // by agent, of the runs read so far
  RunsByAgent contract_failures_, foreign_body_runs_;                       // of the runs read so far
  WorstRuns worst_inside_{kWorstRuns}, worst_outside_{kWorstRuns};
};

// Whether a gate that decides names the agent. Without any gate that decides, every agent is under test.
bool is_under_test(const std::vector<GateRecord>& gates, const std::string& agent);

// Of the gates that decide: violated if one of them is violated; demonstrated if all are demonstrated; otherwise, and
// without such a gate, not demonstrated.
Verdict overall_verdict(const Evidence& evidence, const std::vector<GateResult>& gates);

}  // namespace fleetproof
