#pragma once

#include <string>
#include <vector>

#include "campaign/run/agent_programs.hpp"
#include "campaign/shrink/case_host.hpp"
#include "core/engine/run_watch.hpp"
#include "core/scenario/scenario.hpp"

namespace fleetproof::cli {

// The calls at which the agents of one run end the process or never return, found out in a worker process. Where these
// are known, the run can be simulated, and watched, in this process (RunWatch::known_ends). None of a reference agent.
// `known`: the agent is known, and not loaded. Throws
// InputError if it does not end at the same call twice.
std::vector<KnownEnd> known_ends(const Scenario& scenario, const CaseAgent& agent, const AgentPrograms& known);

// A run of software that is not built in, simulated in a worker process.
struct SimulatedElsewhere {
  std::string recording;       // played here, it is the run, and none of the software's code runs in this process
  std::vector<KnownEnd> ends;  // without a recording: what this process needs to simulate it
};
// The same of both. Neither of a reference agent. Throws what known_ends() throws.
SimulatedElsewhere simulated_elsewhere(const Scenario& scenario, const CaseAgent& agent, const AgentPrograms& known);

}  // namespace fleetproof::cli
