#include "reports/evidence/evidence.hpp"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "core/base/error.hpp"
#include "core/outcome/probe_names.hpp"
#include "reports/evidence/gate_table.hpp"
#include "storage/records.hpp"

namespace fleetproof {
namespace {

// Rows of the tables: agents in the order in which the campaign names them, so that the same campaign always prints the
// same page.
std::vector<Pool> condition_pools(const std::vector<CellRecord>& cells) {
  std::map<std::string, std::size_t> order;
  std::map<std::tuple<std::size_t, FactorValues, FactorValues>, Pool> pools;
  for (const auto& cell : cells) {
    const auto agent = order.try_emplace(cell.agent, order.size()).first->second;
    pools[{agent, cell.lowest, cell.highest}].cells.push_back(cell.index);
  }
  std::vector<Pool> list;
  for (auto& [key, pool] : pools) list.push_back(std::move(pool));
  return list;
}

}  // namespace

Evidence::Evidence(const StoredPlan& plan)
    : counts_only_(plan.campaign.kind == "search"),
      planned_(plan.campaign.replicates),
      sampling_(plan.campaign.sampling),
      held_streams_(plan.campaign.held_streams),
      held_replicate_(plan.campaign.held_replicate),
      cells_(plan.cells),
      gates_(plan.gates),
      tallies_(cells_.size()),
      pending_tallies_(cells_.size()),
      pools_of_cell_(cells_.size()) {
  for (std::size_t i = 0; i < cells_.size(); ++i) ensure(cells_[i].index == i, "cells are numbered from 0 on");
  for (const auto& cell : cells_) {
    for (const FactorInfo& factor : kFactors)
      ensure(cell.lowest[factor.id] <= cell.highest[factor.id], "the upper bound is not below the lower");
  }
  for (auto& gate : gates_) {
    Pool pool;
    pool.rule = {gate.end_point, gate.unit, gate.min_transports_per_agv_hour};
    for (const auto& cell : cells_) {
      if (covers(gate, cell)) pool.cells.push_back(cell.index);
    }
    if (gate.table == GateTable{}) gate.table = gate_table(gate, pool.cells.size(), planned_);
    pools_.emplace_back(std::move(pool));
  }
  for (auto& pool : condition_pools(cells_)) pools_.emplace_back(std::move(pool));
  required_probes_ = plan.campaign.required_probes;
  coverage_.resize(pools_.size());
  pending_coverage_.resize(pools_.size());
  worst_of_pool_.resize(pools_.size(), WorstRuns(1));
  worst_unknown_of_pool_.resize(pools_.size(), WorstRuns(1));
  for (std::size_t i = 0; i < pools_.size(); ++i) {
    for (const auto cell : pools_[i].pool().cells) pools_of_cell_[cell].push_back(i);
  }
}

void Evidence::add(const RunRecord& run) {
  ensure(run.run_index == runs_, "evidence takes runs in order of their index, without gaps");
  ensure(run.cell < cells_.size() && run.run_index == run.replicate * cells_.size() + run.cell,
         "run_index = replicate x cells + cell");
  ++runs_;
  engine_errors_ += run.outcome.engine_error;
  const RunResult violation = result_of(run.outcome, EndPoint::Violation);
  pending_tallies_[run.cell] = Tally::of(run.outcome, violation);
  if (const auto failing = FailingRun::of(run)) {
    (run.factors.in_contract() ? worst_inside_ : worst_outside_).add(*failing);
    if (run.factors.in_contract() && (run.outcome.violation || run.outcome.contact)) {
      add_to(violation == RunResult::Failed ? contract_failures_ : foreign_body_runs_, *failing);
    }
  }
  add_incidents(run);
  for (const auto pool : pools_of_cell_[run.cell]) {
    pending_coverage_[pool].add(run.outcome);
    add_to_pool(pool, run, violation);
  }
  if (run.cell + 1 == cells_.size()) finish_replicate();
}

void Evidence::add_incidents(const RunRecord& run) {
  std::map<IncidentKind, std::uint64_t> incidents;
  for (const auto& incident : run.outcome.incidents) {
    if (accuses(incident.kind)) ++incidents[incident.kind];
  }
  for (const auto& [kind, count] : incidents) {
    auto& tally =
        incidents_[cells_[run.cell].agent].try_emplace(kind, IncidentTally{0, 0, run.run_index}).first->second;
    ++tally.runs;
    tally.incidents += count;
  }
}

bool Evidence::quiet_counts() const {
  return std::ranges::none_of(gates_, [](const GateRecord& gate) { return gate.end_point == EndPoint::Throughput; });
}

void Evidence::add(const QuietReplicates& quiet) {
  ensure(runs_ % cells_.size() == 0, "whole replicates follow whole replicates");
  runs_ += quiet.replicates * cells_.size();
  replicates_ += quiet.replicates;
  for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
    tallies_[cell].add(quiet.by_cell[cell]);
    for (const auto pool : pools_of_cell_[cell]) coverage_[pool].add(quiet.by_cell[cell]);
  }
  for (PoolCounter& pool : pools_) pool.add(quiet);
}

void Evidence::add_met(std::uint32_t cell, const std::vector<MetTotal>& met) {
  ensure(cell < cells_.size(), "folded runs belong to a cell of the campaign");
  for (const auto pool : pools_of_cell_[cell]) coverage_[pool].add(met);
}

void Evidence::add_to(RunsByAgent& runs, const FailingRun& run) const {
  const auto& agent = cells_[run.cell].agent;
  AgentRuns& of_agent = runs.try_emplace(agent, AgentRuns{agent, 0, run}).first->second;
  ++of_agent.runs;
  if (more_serious(run, of_agent.worst)) of_agent.worst = run;
}

std::vector<AgentRuns> Evidence::in_order(const RunsByAgent& runs) const {
  std::vector<AgentRuns> list;
  for (std::size_t i = gates_.size(); i < pools_.size(); ++i) {
    const auto found = runs.find(cells_[pools_[i].pool().cells.front()].agent);
    const bool listed =
        !list.empty() && found != runs.end() && list.back().agent == found->first;  // conditions come agent by agent
    if (found != runs.end() && !listed) list.push_back(found->second);
  }
  return list;
}

void Evidence::add_to_pool(std::size_t index, const RunRecord& run, RunResult violation) {
  const RunResult result = pools_[index].add(run, violation);
  if (result == RunResult::Passed) return;
  const auto failing = FailingRun::of(run);
  if (!failing) return;  // a slow run is none
  (result == RunResult::Failed ? worst_of_pool_ : worst_unknown_of_pool_)[index].add(*failing);
}

std::optional<FailingRun> Evidence::worst_of(std::size_t pool) const {
  for (const auto* runs : {&worst_of_pool_, &worst_unknown_of_pool_}) {
    if (const auto& list = (*runs)[pool].list(); !list.empty()) return list.front();
  }
  return std::nullopt;
}

void Evidence::finish_replicate() {
  ++replicates_;
  for (std::size_t i = 0; i < tallies_.size(); ++i) tallies_[i].add(pending_tallies_[i]);
  for (std::size_t i = 0; i < pools_.size(); ++i) {
    pending_coverage_[i].empty_into(coverage_[i]);
    pools_[i].finish_replicate();
  }
}

GateResult Evidence::judge(std::size_t index) const {
  ensure(index < gates_.size(), "a gate of the campaign is judged");
  const Pool& pool = pools_[index].pool();
  // Outside the contract region, safe mode (standing still) is legal. Progress is required inside the region, or
  // everywhere if the gate has no cell inside.
  std::vector<std::uint32_t> due;
  std::ranges::copy_if(pool.cells, std::back_inserter(due),
                       [&](std::uint32_t cell) { return cells_[cell].in_contract(); });
  if (due.empty()) due = pool.cells;
  Tally progress;
  GateCounts counts;
  counts.due_cells = due.size();
  for (const auto cell : due) {
    progress.add(tallies_[cell]);
    counts.idle_cells += tallies_[cell].transports_done == 0;
  }
  counts.cells = pool.cells.size();
  counts.units = pool.units;
  counts.most_units = pool.most_units;
  counts.replicates = replicates_;
  counts.planned = planned_;
  counts.failing = pool.failing;
  counts.failing_or_unknown = pool.failing_or_unknown;
  counts.failing_runs = pool.failing_runs;
  counts.transports_per_agv_hour = progress.transports_per_agv_hour();
  counts.counts_only = counts_only_;
  const bool asks_for_encounters = std::ranges::find(required_probes_, kEncounterProbe) != required_probes_.end();
  counts.met_nobody = asks_for_encounters && coverage_[index].seen(kEncounterProbe).runs == 0;
  auto result = judge_gate(gates_[index], counts);
  if (!pool.cells.empty()) result.missing = missing_probes(coverage_[index], required_probes_);
  result.worst = worst_of(index);
  return result;
}

std::vector<GateResult> Evidence::judge_all() const {
  std::vector<GateResult> results;
  for (std::size_t i = 0; i < gates_.size(); ++i) results.push_back(judge(i));
  return results;
}

std::vector<Condition> Evidence::conditions() const {
  std::vector<Condition> list;
  for (std::size_t i = gates_.size(); i < pools_.size(); ++i) {
    const auto& first = cells_[pools_[i].pool().cells.front()];
    Condition condition{first.agent,           first.lowest, first.highest,    first.in_contract(),
                        first.is_worst_case(), {},           pools_[i].pool(), {}};
    for (const auto cell : pools_[i].pool().cells) condition.tally.add(tallies_[cell]);
    condition.worst = worst_of(i);
    list.push_back(std::move(condition));
  }
  return list;
}

std::vector<AgentCoverage> Evidence::agent_coverage() const {
  std::vector<AgentCoverage> list;
  for (std::size_t i = gates_.size(); i < pools_.size(); ++i) {
    const auto& agent = cells_[pools_[i].pool().cells.front()].agent;
    if (list.empty() || list.back().agent != agent) list.push_back({agent, {}, {}, {}});
    list.back().coverage.add(coverage_[i]);
  }
  for (auto& agent : list) {
    agent.missing = missing_probes(agent.coverage, required_probes_);
    if (const auto found = incidents_.find(agent.agent); found != incidents_.end()) agent.incidents = found->second;
  }
  return list;
}

bool is_under_test(const std::vector<GateRecord>& gates, const std::string& agent) {
  bool any_decides = false;
  for (const GateRecord& gate : gates) {
    if (gate.decides && gate.agent == agent) return true;
    any_decides |= gate.decides;
  }
  return !any_decides;
}

Verdict overall_verdict(const Evidence& evidence, const std::vector<GateResult>& gates) {
  std::size_t deciding = 0, violated = 0, demonstrated = 0;
  for (std::size_t i = 0; i < gates.size(); ++i) {
    if (!evidence.gates()[i].decides) continue;
    ++deciding;
    violated += gates[i].verdict == Verdict::Violated ? 1 : 0;
    demonstrated += gates[i].verdict == Verdict::Demonstrated ? 1 : 0;
  }
  if (violated > 0) return Verdict::Violated;
  const bool all = deciding > 0 && demonstrated == deciding;
  return all && evidence.runs() > 0 ? Verdict::Demonstrated : Verdict::NotDemonstrated;
}

}  // namespace fleetproof
