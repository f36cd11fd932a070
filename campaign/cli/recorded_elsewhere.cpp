#include "campaign/cli/recorded_elsewhere.hpp"

#include "campaign/shrink/case_host.hpp"
#include "core/base/error.hpp"

namespace fleetproof::cli {

std::string recorded_elsewhere(const Scenario& scenario, const CaseAgent& agent, const AgentPrograms& known) {
  if (!known.needs_worker(factor_of(agent))) return {};
  CaseHost host(agent, known, 1);
  if (std::string recording = host.recording_of(scenario); !recording.empty()) return recording;
  if (!host.ends_in(scenario))
    throw InputError(agent.program,
                     "this agent does not crash or hang at the same call twice, so the run cannot be watched; with "
                     "--in-process it runs in this process, whatever it does to it");
  throw InputError(agent.program,
                   "its agents do more in this run than the 4 GiB that a recording may have, so the run cannot be "
                   "watched; make it shorter, or run the agent in this process with --in-process");
}

}  // namespace fleetproof::cli
