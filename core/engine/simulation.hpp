#pragma once

#include <memory>
#include <span>

#include "core/outcome/law.hpp"
#include "core/outcome/outcome.hpp"
#include "core/outcome/trace.hpp"
#include "core/scenario/scenario.hpp"
#include "core/sdk/fleetproof/agent.h"

namespace fleetproof {

// One run: a pure function of scenario and agent. Laws observe. The first one is the judge of violations; the incidents
// and the coverage of all are filed in the outcome. Neither laws nor sink can change the trace. An agent that crashes
// or hangs stops answering and its AGV stands still; the run goes on. A bug of the engine ends the run as an outcome
// with `engine_error`. `agent_config` is handed to every agent as its own parameters. Threads: any number of runs at
// once; one run stays on its thread.
Outcome simulate(const Scenario& scenario, const fp_agent_type& agent, std::span<const std::unique_ptr<Law>> laws,
                 TraceSink* sink = nullptr, const char* agent_config = "");

// Throws InputError unless the agent speaks this host's ABI.
void check_abi(const fp_agent_type& agent);

}  // namespace fleetproof
