#include "campaign/cli/known_ends.hpp"

#include "campaign/shrink/case_host.hpp"
#include "core/base/error.hpp"

namespace fleetproof::cli {

std::vector<KnownEnd> known_ends(const Scenario& scenario, const CaseAgent& agent, const AgentPrograms& known) {
  CaseHost host(agent, known, 1);
  if (auto ends = host.ends_in(scenario)) return *std::move(ends);
  throw InputError(agent.program,
                   "this agent does not crash or hang at the same call twice, so the run cannot be watched; with "
                   "--in-process it runs in this process, whatever it does to it");
}

SimulatedElsewhere simulated_elsewhere(const Scenario& scenario, const CaseAgent& agent, const AgentPrograms& known) {
  SimulatedElsewhere found;
  found.recording = CaseHost(agent, known, 1).recording_of(scenario);
  if (found.recording.empty()) found.ends = known_ends(scenario, agent, known);
  return found;
}

}  // namespace fleetproof::cli
