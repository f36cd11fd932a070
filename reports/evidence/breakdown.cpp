#include "reports/evidence/breakdown.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "core/outcome/run_result.hpp"

namespace fleetproof {
namespace {

// Behind a wreck nothing moves: that is no fault of its own (run_result.hpp calls it unknown).
bool stalls(const Outcome& outcome) {
  if (outcome.incidents.empty()) return false;
  return std::ranges::any_of(kValuesOf<EndPoint>, [&](EndPoint end_point) {
    return is_stall(end_point) && result_of(outcome, end_point) == RunResult::Failed;
  });
}

// Of the agents, in the order of the campaign: a group of all cells, then the layouts, then the fleet sizes.
std::vector<std::pair<BreakdownKey, std::vector<std::uint32_t>>> grouped_cells(const std::vector<CellRecord>& cells) {
  std::vector<std::pair<BreakdownKey, std::vector<std::uint32_t>>> groups;
  std::vector<std::string> agents;
  for (const CellRecord& cell : cells) {
    if (std::ranges::find(agents, cell.agent) == agents.end()) agents.push_back(cell.agent);
  }
  const auto put = [&](const BreakdownKey& key, std::uint32_t cell) {
    const auto found = std::ranges::find(
        groups, key, [](const auto& group) -> const auto& { return group.first; });
    auto& members = found == groups.end() ? groups.emplace_back(key, std::vector<std::uint32_t>{}) : *found;
    members.second.push_back(cell);
  };
  for (const std::string& agent : agents) {
    for (const int kind : {0, 1, 2}) {
      for (const CellRecord& cell : cells) {
        if (cell.agent != agent) continue;
        BreakdownKey key{agent, "", 0, cell.in_contract()};
        if (kind == 1) key.layout = cell.layout;
        if (kind == 2) key.fleet_size = cell.fleet_size;
        put(key, cell.index);
      }
    }
  }
  return groups;
}

}  // namespace

Breakdown::Breakdown(const StoredPlan& plan)
    : tallies_(plan.cells.size()), pending_tallies_(plan.cells.size()), groups_of_cell_(plan.cells.size()) {
  for (auto& [key, members] : grouped_cells(plan.cells)) {
    for (const std::uint32_t cell : members) groups_of_cell_[cell].push_back(groups_.size());
    const GateCells cells = gate_cells(plan, members);
    Pool pool;
    pool.cells = std::move(members);
    groups_.push_back({key, cells, PoolCounter(std::move(pool))});
  }
}

void Breakdown::add(const RunRecord& run) {
  const RunResult violation = result_of(run.outcome, EndPoint::Violation);
  pending_tallies_[run.cell] = Tally::of(run, violation);
  const bool stalled = stalls(run.outcome);
  for (const std::size_t index : groups_of_cell_[run.cell]) {
    Group& group = groups_[index];
    group.worlds.add(run, violation);
    if (stalled && !group.stalls_in) group.stalls_in = run.run_index;
  }
  if (run.cell + 1 == groups_of_cell_.size()) finish_replicate();
}

void Breakdown::add(const QuietReplicates& quiet) {
  for (Group& group : groups_) group.worlds.add(quiet);
  for (std::size_t cell = 0; cell < tallies_.size(); ++cell) tallies_[cell].add(quiet.by_cell[cell]);
}

void Breakdown::finish_replicate() {
  for (std::size_t cell = 0; cell < tallies_.size(); ++cell) tallies_[cell].add(pending_tallies_[cell]);
  for (Group& group : groups_) {
    group.worlds.finish_replicate();
    if (!group.stalls_in) continue;
    ++group.stalled;
    if (!group.first_stalled) group.first_stalled = group.stalls_in;
    group.stalls_in.reset();
  }
}

std::vector<BreakdownRow> Breakdown::rows() const {
  std::vector<BreakdownRow> list;
  for (const Group& group : groups_) {
    Tally tally;
    for (const std::uint32_t cell : group.worlds.pool().cells) tally.add(tallies_[cell]);
    list.push_back({group.key, tally, group.worlds.pool(), group.cells, group.stalled, group.first_stalled,
                    static_cast<double>(tally.longest_ns) / 1e9});
  }
  return list;
}

}  // namespace fleetproof
