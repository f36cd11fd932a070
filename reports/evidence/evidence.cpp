#include "reports/evidence/evidence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/json_text.hpp"
#include "core/base/outside_text.hpp"
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

// A world has the computers for which its agent has programs, in the order of the plan.
std::map<std::string, std::vector<std::string>> computers_of_agents(const std::string& plan_json) {
  std::map<std::string, std::vector<std::string>> by_agent;
  const SortedJson plan = read_sorted_json(plan_json);
  const SortedJson::json_pointer agents("/factors/agents");
  if (plan.is_discarded() || !plan.contains("computers") || !plan.contains(agents)) return by_agent;
  for (const auto& agent : plan.at(agents)) {
    if (!agent.is_object() || !agent.contains("computers")) continue;
    for (const auto& computer : plan.at("computers")) {
      const auto name = computer.value("name", std::string());
      if (agent.at("computers").contains(name)) by_agent[agent.value("name", std::string())].push_back(name);
    }
  }
  return by_agent;
}

}  // namespace

Evidence::Evidence(const StoredPlan& plan)
    : plan_(plan),
      computers_(computers_of_agents(plan.campaign.plan_json)),
      audits_(plan),
      tallies_(plan.cells.size()),
      pending_tallies_(plan.cells.size()),
      pools_of_cell_(plan.cells.size()) {
  for (std::size_t i = 0; i < plan_.cells.size(); ++i)
    ensure(plan_.cells[i].index == i, "cells are numbered from 0 on");
  for (const auto& cell : plan_.cells) {
    for (const FactorInfo& factor : kFactors)
      ensure(cell.lowest[factor.id] <= cell.highest[factor.id], "the upper bound is not below the lower");
  }
  for (auto& gate : plan_.gates) {
    Pool pool;
    pool.rule = {gate.end_point, gate.unit, gate.min_transports_per_agv_hour};
    pool.cells = fleetproof::cells_of(gate, plan_.cells);
    gate_cells_.push_back(fleetproof::gate_cells(plan, pool.cells));
    const GateTable stored = gate.table;
    if (stored == GateTable{} || gate.unit == GateUnit::AgvHour)
      gate.table = gate_table(gate, gate_cells_.back(), planned_replicates());
    judged_anew_.push_back(stored != GateTable{} && stored != gate.table);
    pools_.emplace_back(std::move(pool));
  }
  for (auto& pool : condition_pools(plan_.cells)) pools_.emplace_back(std::move(pool));
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
  ensure(run.cell < plan_.cells.size() && run.run_index == run.replicate * plan_.cells.size() + run.cell,
         "run_index = replicate x cells + cell");
  ++runs_;
  engine_errors_ += run.outcome.engine_error;
  repeated_runs_ += run.repeats ? 1 : 0;
  const std::optional<AuditRecord> differing = audits_.add(run);
  const AuditedOutcome* const audit = differing && differing->outcome ? &*differing->outcome : nullptr;
  const RunResult violation = result_of(run.outcome, EndPoint::Violation);
  pending_tallies_[run.cell] = Tally::of(run, violation);
  if (const auto failing = FailingRun::of(run)) {
    (run.factors.in_contract() ? worst_inside_ : worst_outside_).add(*failing);
    if (run.factors.in_contract() && (run.outcome.violation || run.outcome.contact)) {
      add_to(violation == RunResult::Failed ? contract_failures_ : foreign_body_runs_, *failing);
    }
  }
  add_incidents(run);
  for (const auto pool : pools_of_cell_[run.cell]) {
    pending_coverage_[pool].add(run.outcome);
    add_to_pool(pool, run, violation, audit);
  }
  if (run.cell + 1 == plan_.cells.size()) finish_replicate();
}

void Evidence::add_incidents(const RunRecord& run) {
  std::map<IncidentKind, std::uint64_t> incidents;
  for (const auto& incident : run.outcome.incidents) {
    if (!is_condition(incident.kind)) ++incidents[incident.kind];
  }
  for (const auto& [kind, count] : incidents) {
    auto& tally =
        incidents_[plan_.cells[run.cell].agent].try_emplace(kind, IncidentTally{0, 0, run.run_index}).first->second;
    ++tally.runs;
    tally.incidents += count;
  }
}

bool Evidence::quiet_counts() const {
  return std::ranges::none_of(plan_.gates,
                              [](const GateRecord& gate) { return gate.end_point == EndPoint::Throughput; });
}

void Evidence::add(const QuietReplicates& quiet) {
  ensure(runs_ % plan_.cells.size() == 0, "whole replicates follow whole replicates");
  audits_.add_quiet(replicates_, quiet.replicates);
  runs_ += quiet.replicates * plan_.cells.size();
  replicates_ += quiet.replicates;
  for (std::size_t cell = 0; cell < plan_.cells.size(); ++cell) {
    tallies_[cell].add(quiet.by_cell[cell]);
    for (const auto pool : pools_of_cell_[cell]) coverage_[pool].add(quiet.by_cell[cell]);
  }
  for (PoolCounter& pool : pools_) pool.add(quiet);
}

void Evidence::add_met(std::uint32_t cell, const std::vector<MetTotal>& met) {
  ensure(cell < plan_.cells.size(), "folded runs belong to a cell of the campaign");
  for (const auto pool : pools_of_cell_[cell]) coverage_[pool].add(met);
}

void Evidence::add_to(RunsByAgent& runs, const FailingRun& run) const {
  const auto& agent = plan_.cells[run.cell].agent;
  AgentRuns& of_agent = runs.try_emplace(agent, AgentRuns{agent, 0, run}).first->second;
  ++of_agent.runs;
  if (more_serious(run, of_agent.worst)) of_agent.worst = run;
}

std::vector<AgentRuns> Evidence::in_order(const RunsByAgent& runs) const {
  std::vector<AgentRuns> list;
  for (std::size_t i = plan_.gates.size(); i < pools_.size(); ++i) {
    const auto found = runs.find(plan_.cells[pools_[i].pool().cells.front()].agent);
    const bool listed =
        !list.empty() && found != runs.end() && list.back().agent == found->first;  // conditions come agent by agent
    if (found != runs.end() && !listed) list.push_back(found->second);
  }
  return list;
}

void Evidence::add_to_pool(std::size_t index, const RunRecord& run, RunResult violation, const AuditedOutcome* audit) {
  const RunResult result = pools_[index].add(run, violation, audit);
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

// A world that passed is no evidence if all of its runs repeat others: there are at most so many such worlds.
UnitCount Evidence::counted(const UnitCount& count, std::size_t cells) const {
  UnitCount least = count;
  const std::uint64_t repeated = cells == 0 ? 0 : unplaced_repeats_ / cells;
  least.distinct -= std::min(repeated, least.distinct);
  least.counted -= std::min(repeated, least.counted - least.failing_or_unknown);
  return least;
}

GateResult Evidence::judge(std::size_t index) const {
  ensure(index < plan_.gates.size(), "a gate of the campaign is judged");
  const Pool& pool = pools_[index].pool();
  // Outside the contract region, safe mode (standing still) is legal. Progress is required inside the region, or
  // everywhere if the gate has no cell inside.
  std::vector<std::uint32_t> due;
  std::ranges::copy_if(pool.cells, std::back_inserter(due),
                       [&](std::uint32_t cell) { return plan_.cells[cell].in_contract(); });
  if (due.empty()) due = pool.cells;
  Tally progress;
  const GateRecord& gate = plan_.gates[index];
  std::vector<UnitCount> units;
  for (const UnitCount& count : pool.runs_by_cell) units.push_back(counted(count, 1));
  if (units.empty()) units.push_back(counted(pool.worlds, pool.cells.size()));
  GateCounts counts;
  static_cast<UnitCount&>(counts) = deciding_count(gate, units, gate_cells_[index]);
  counts.due_cells = due.size();
  for (const auto cell : due) {
    progress.add(tallies_[cell]);
    counts.idle_cells += tallies_[cell].transports_done == 0;
  }
  counts.cells = gate_cells_[index];
  counts.replicates = replicates_;
  counts.planned = planned_replicates();
  counts.failing_runs = pool.failing_runs;
  counts.failing_audits = pool.failing_audits;
  if (!pool.cells.empty()) counts.doubt = audit_doubt(audits_.of(gate.agent));
  if (counts.doubt.empty() && has_several_programs(plan_.campaign.engine))
    counts.doubt = "its runs are those of more than one program";
  if (counts.doubt.empty() && !is_sealed_)
    counts.doubt = "the campaign is not at an end, and its file not sealed; the same command goes on";
  counts.transports_per_agv_hour = progress.transports_per_agv_hour();
  counts.counts_only = counts_only();
  const bool asks_for_encounters =
      std::ranges::find(plan_.campaign.required_probes, kEncounterProbe) != plan_.campaign.required_probes.end();
  counts.met_nobody = asks_for_encounters && coverage_[index].seen(kEncounterProbe).runs == 0;
  auto result = judge_gate(gate, counts);
  if (!pool.cells.empty()) result.missing = missing_of(gate.agent, coverage_[index]);
  result.worst = worst_of(index);
  return result;
}

std::vector<GateResult> Evidence::judge_all() const {
  std::vector<GateResult> results;
  for (std::size_t i = 0; i < plan_.gates.size(); ++i) results.push_back(judge(i));
  return results;
}

std::vector<Condition> Evidence::conditions() const {
  std::vector<Condition> list;
  for (std::size_t i = plan_.gates.size(); i < pools_.size(); ++i) {
    const auto& first = plan_.cells[pools_[i].pool().cells.front()];
    Condition condition{first.agent,           first.lowest, first.highest,    first.in_contract(),
                        first.is_worst_case(), {},           pools_[i].pool(), {}};
    condition.pool.worlds = counted(condition.pool.worlds, condition.pool.cells.size());
    for (const auto cell : pools_[i].pool().cells) condition.tally.add(tallies_[cell]);
    condition.worst = worst_of(i);
    list.push_back(std::move(condition));
  }
  return list;
}

const std::vector<std::string>& Evidence::computers_of(const std::string& agent) const {
  static const std::vector<std::string> kNone;
  const auto found = computers_.find(agent);
  return found == computers_.end() ? kNone : found->second;
}

// AGVs of a central fleet ask their server, not each other.
std::vector<MissingProbe> Evidence::missing_of(const std::string& agent, const Coverage& coverage) const {
  std::vector<std::string> required = plan_.campaign.required_probes;
  if (!computers_of(agent).empty()) std::erase(required, kNegotiationOnBoard);
  return missing_probes(coverage, required);
}

std::vector<AgentCoverage> Evidence::agent_coverage() const {
  std::vector<AgentCoverage> list;
  for (std::size_t i = plan_.gates.size(); i < pools_.size(); ++i) {
    const auto& agent = plan_.cells[pools_[i].pool().cells.front()].agent;
    if (list.empty() || list.back().agent != agent) list.push_back({agent, {}, {}, {}});
    list.back().coverage.add(coverage_[i]);
  }
  for (auto& agent : list) {
    agent.missing = missing_of(agent.agent, agent.coverage);
    if (const auto found = incidents_.find(agent.agent); found != incidents_.end()) agent.incidents = found->second;
  }
  return list;
}

bool is_under_test(const StoredPlan& plan, const std::string& agent) {
  const auto& named = plan.campaign.agents_under_test;
  if (!named.empty()) return std::ranges::find(named, agent) != named.end();
  bool any_decides = false;
  for (const GateRecord& gate : plan.gates) {
    if (gate.decides && gate.agent == agent) return true;
    any_decides |= gate.decides;
  }
  return !any_decides;
}

namespace {

bool asks_for_safety(EndPoint end_point) {
  return end_point == EndPoint::Violation || end_point == EndPoint::Contact || end_point == EndPoint::HazardousContact;
}

// By cell: whether a gate that decides asks for violations or contacts there.
std::vector<bool> judged_cells(const Evidence& evidence) {
  std::vector<bool> judged(evidence.cells().size());
  for (std::size_t i = 0; i < evidence.gates().size(); ++i) {
    const GateRecord& gate = evidence.gates()[i];
    if (!gate.decides || !asks_for_safety(gate.end_point)) continue;
    for (const std::uint32_t cell : evidence.cells_of(i)) judged[cell] = true;
  }
  return judged;
}

}  // namespace

std::vector<std::string> unjudged_agents(const Evidence& evidence) {
  std::vector<std::string> sentences;
  if (evidence.gates().empty() || evidence.counts_only()) return sentences;
  const std::vector<bool> judged = judged_cells(evidence);
  for (const AgentAudit& each : evidence.audits().agents()) {
    if (!is_under_test(evidence.plan(), each.agent)) continue;
    std::vector<CellRecord> due, all;
    for (const CellRecord& cell : evidence.cells()) {
      if (cell.agent != each.agent) continue;
      all.push_back(cell);
      if (cell.in_contract()) due.push_back(cell);
    }
    const bool in_contract = !due.empty();
    if (!in_contract) due = all;
    const std::string where = in_contract ? " in the contract region" : "";
    const std::string agent = printable(each.agent, 40);
    if (std::ranges::none_of(due, [&](const CellRecord& cell) { return judged[cell.index]; })) {
      sentences.push_back(
          fmt::format("{} is under test, and no gate asks whether it breaks the safety distance{}", agent, where));
      continue;
    }
    const auto fails_unseen = [&](const CellRecord& cell) {
      return !judged[cell.index] && evidence.tally(cell.index).violating_runs > 0;
    };
    if (const auto count = std::ranges::count_if(due, fails_unseen); count > 0)
      sentences.push_back(fmt::format("{} broke the safety distance in {}{} for which no gate asks", agent,
                                      count == 1 ? "a cell" : fmt::format("{} cells", count), where));
  }
  return sentences;
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
  const bool all = deciding > 0 && demonstrated == deciding && unjudged_agents(evidence).empty();
  return all && evidence.runs() > 0 ? Verdict::Demonstrated : Verdict::NotDemonstrated;
}

}  // namespace fleetproof
