#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "reports/evidence/audit_tally.hpp"
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

  // What an audit found. Before its run is added.
  void know(const AuditedRun& audit) { audits_.know(audit); }
  // Adds the next run. Requires: its run_index == runs().
  void add(const RunRecord& run);
  // Instead, for whole replicates. Requires: quiet_counts().
  void add(const QuietReplicates& quiet);
  // Whether it is enough to know many quiet runs together: no gate asks whether a single one was slow.
  bool quiet_counts() const;
  // What folded runs of the cell met. Requires: they belong to complete replicates.
  void add_met(std::uint32_t cell, const std::vector<MetTotal>& met);

  // So many of the runs to come have a trace that an earlier run of their cell had, and nobody knows which.
  void know_unplaced_repeats(std::uint64_t runs) { unplaced_repeats_ = runs; }
  // The runs are those of a file that nobody has sealed: it may say anything.
  void know_unsealed() { is_sealed_ = false; }
  void know_recordings(const std::string& agent, std::uint64_t count) { audits_.add_recordings(agent, count); }

  bool counts_only() const { return plan_.campaign.kind == "search"; }  // a campaign of kind "search"
  std::uint64_t runs() const { return runs_; }                          // read so far
  std::uint64_t complete_replicates() const { return replicates_; }
  std::uint64_t planned_replicates() const { return plan_.campaign.replicates; }
  bool complete() const { return replicates_ >= planned_replicates(); }  // every planned replicate is complete
  std::uint64_t engine_errors() const { return engine_errors_; }         // among the runs read so far
  const StoredPlan& plan() const { return plan_; }                       // its gates have their tables
  const std::vector<CellRecord>& cells() const { return plan_.cells; }
  const std::vector<GateRecord>& gates() const { return plan_.gates; }
  // The names of an agent's computers, in the order of their ids, behind those of the AGVs. Empty: it runs on board.
  const std::vector<std::string>& computers_of(const std::string& agent) const;
  const Tally& tally(std::uint32_t cell) const { return tallies_.at(cell); }
  const std::vector<std::uint32_t>& cells_of(std::size_t gate) const { return pools_.at(gate).pool().cells; }
  const GateCells& gate_cells(std::size_t gate) const { return gate_cells_.at(gate); }
  // The file has another table for the gate: older programs counted AGV-hours in another way.
  bool is_judged_anew(std::size_t gate) const { return judged_anew_.at(gate); }

  const AuditTally& audits() const { return audits_; }
  std::uint64_t repeated_runs() const { return repeated_runs_ + unplaced_repeats_; }  // among the runs read so far
  // What a claim may count of a pool's units.
  UnitCount counted(const UnitCount& count, std::size_t cells) const;

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
  void add_to_pool(std::size_t index, const RunRecord& run, RunResult violation, const AuditedOutcome* audit);
  std::optional<FailingRun> worst_of(std::size_t pool) const;  // that failed; else that stayed unknown
  void add_incidents(const RunRecord& run);
  void finish_replicate();
  std::vector<MissingProbe> missing_of(const std::string& agent, const Coverage& coverage) const;

  StoredPlan plan_;
  std::map<std::string, std::vector<std::string>> computers_;  // by agent; agents on board have none
  std::vector<GateCells> gate_cells_;                          // by gate
  std::vector<bool> judged_anew_;                              // in the same order
  std::uint64_t runs_ = 0, replicates_ = 0, engine_errors_ = 0;
  std::uint64_t repeated_runs_ = 0, unplaced_repeats_ = 0;
  bool is_sealed_ = true;
  AuditTally audits_;
  std::vector<Tally> tallies_, pending_tallies_;  // by cell
  std::vector<PoolCounter> pools_;                // one for each gate, then one for each condition
  std::vector<std::vector<std::size_t>> pools_of_cell_;
  std::vector<WorstRuns> worst_of_pool_;                                    // that failed, in the same order
  std::vector<WorstRuns> worst_unknown_of_pool_;                            // of unknown outcome
  std::vector<Coverage> coverage_, pending_coverage_;                       // in the same order
  std::map<std::string, std::map<IncidentKind, IncidentTally>> incidents_;  // by agent, of the runs read so far
  RunsByAgent contract_failures_, foreign_body_runs_;                       // of the runs read so far
  WorstRuns worst_inside_{kWorstRuns}, worst_outside_{kWorstRuns};
};

// Whether the verdict is about the agent. In a file that does not say so: whether a gate that decides names it; without
// any such gate, every agent is under test.
bool is_under_test(const StoredPlan& plan, const std::string& agent);

// Of the agents under test: those with runs in the contract region (in all cells, if it has none there) for which no
// gate that decides asks for violations or contacts, in a sentence each. Without any gate, none.
std::vector<std::string> unjudged_agents(const Evidence& evidence);

// Of the gates that decide: violated if one of them is violated; demonstrated if all are demonstrated and no agent is
// unjudged; otherwise, and without such a gate, not demonstrated.
Verdict overall_verdict(const Evidence& evidence, const std::vector<GateResult>& gates);

}  // namespace fleetproof
