#pragma once

#include <string>

#include "campaign/run/agent_programs.hpp"
#include "campaign/shrink/case_host.hpp"
#include "core/scenario/scenario.hpp"

namespace fleetproof::cli {

// What the agents of one run did, recorded in a worker process. Played here, it is the run, and none of the software's
// code runs in this process (RunWatch::play). Empty of a reference agent, which this process simulates itself.
// `known`: the agent is known, and not loaded. Throws InputError if there is no recording.
std::string recorded_elsewhere(const Scenario& scenario, const CaseAgent& agent, const AgentPrograms& known);

}  // namespace fleetproof::cli
