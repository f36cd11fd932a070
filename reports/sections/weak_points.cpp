#include "reports/sections/weak_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "reports/evidence/gate_bounds.hpp"
#include "reports/evidence/gate_words.hpp"
#include "reports/page/wording.hpp"
#include "reports/sections/coverage_section.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kMostNamed = 4;

std::string cell_name(const CellRecord& cell) {
  return fmt::format("{} on {}, fleet of {}, {}", printable(cell.agent, 40), printable(cell.layout, 40),
                     cell.fleet_size, factor_spans(cell.lowest, cell.highest));
}

enum class Scope { Contract, All };

// "3 of 12 cells in the contract region ...: a; b; c", or nothing.
void name_cells(std::vector<std::string>& points, const Evidence& evidence, Scope scope, const std::string& what,
                const std::function<bool(const Tally&)>& concerned) {
  std::vector<std::string> names;
  std::size_t all = 0, count = 0;
  for (const auto& cell : evidence.cells()) {
    if (scope == Scope::Contract && !cell.in_contract()) continue;
    ++all;
    if (concerned(evidence.tally(cell.index)) && ++count <= kMostNamed) names.push_back(cell_name(cell));
  }
  if (count == 0) return;
  auto text =
      fmt::format("{} of {} cells{} {}", count, all, scope == Scope::Contract ? " in the contract region" : "", what);
  if (count < all)
    text += ": " + joined(names, "; ") + (count > kMostNamed ? fmt::format("; and {} more", count - kMostNamed) : "");
  points.push_back(text + ".");
}

// A gate that pools its cells says little about a single cell. Gates with a failure are skipped: the number of runs
// without a failure is no help to them.
void name_short_gates(std::vector<std::string>& points, const ReportInput& input) {
  const Evidence& evidence = input.evidence;
  if (evidence.counts_only()) return;
  for (std::size_t i = 0; i < evidence.gates().size(); ++i) {
    if (input.gates[i].claim && input.gates[i].claim->failing > 0) continue;
    const auto& gate = evidence.gates()[i];
    const auto needed = units_to_pass(gate, 0, 0, evidence.gate_cells(i));
    const auto done = evidence.complete_replicates();
    if (!needed || done >= *needed || evidence.cells_of(i).empty()) continue;
    points.push_back(fmt::format(
        "Gate \"{}\": every cell of it has {}; even without a failure a limit of {} at {} takes {}.",
        printable(gate.name, 60), count_text(done, "run"), limit_text(gate), percent(gate.confidence), *needed));
  }
}

void name_agents_without_gate(std::vector<std::string>& points, const Evidence& evidence) {
  std::vector<std::string> agents;
  for (const auto& cell : evidence.cells()) {
    const auto name = printable(cell.agent, 40);
    const bool has_gate = std::ranges::find(evidence.gates(), cell.agent, &GateRecord::agent) != evidence.gates().end();
    if (!has_gate && std::ranges::find(agents, name) == agents.end()) agents.push_back(name);
  }
  if (!agents.empty()) points.push_back(fmt::format("No gate judges agent {}.", joined(agents)));
}

}  // namespace

std::vector<std::string> weak_points(const ReportInput& input) {
  const auto& evidence = input.evidence;
  std::vector<std::string> points;
  const auto judged = evidence.complete_replicates() * evidence.cells().size();
  if (input.stored_runs > judged) {
    points.push_back(
        fmt::format("{} of {} stored runs are not counted: they belong to replicates that are not complete.",
                    input.stored_runs - judged, input.stored_runs));
  }
  if (evidence.complete_replicates() < input.campaign.replicates) {
    points.push_back(fmt::format("{} of {} planned replicates are complete.", evidence.complete_replicates(),
                                 input.campaign.replicates));
  }
  for (const auto& agent : evidence.agent_coverage()) {
    if (!agent.missing.empty())
      points.push_back(
          fmt::format("The runs of agent {}: {}.", printable(agent.agent, 40), missing_text(agent.missing)));
  }
  name_short_gates(points, input);
  name_cells(points, evidence, Scope::All, "have no run", [](const Tally& tally) { return tally.runs == 0; });
  name_cells(points, evidence, Scope::Contract, "completed no transport",
             [](const Tally& tally) { return tally.runs > 0 && tally.transports_done == 0; });
  name_cells(points, evidence, Scope::All,
             "have runs with an unknown outcome (crash, hang, indeterminate, engine error, fallen load or obstacle)",
             [](const Tally& tally) { return tally.unknown_runs > 0; });
  name_cells(points, evidence, Scope::Contract, "have stuck runs",
             [](const Tally& tally) { return tally.stuck_runs > 0; });
  name_cells(points, evidence, Scope::All, "always have the same run, so that there is no rate",
             [](const Tally& tally) { return tally.runs > 1 && tally.repeats + 1 >= tally.runs; });
  if (evidence.repeated_runs() > 0)
    points.push_back(fmt::format("{} of {} runs have a trace that an earlier run of their cell had.",
                                 evidence.repeated_runs(), evidence.runs()));
  name_agents_without_gate(points, evidence);
  return points;
}

}  // namespace fleetproof
