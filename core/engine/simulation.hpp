#pragma once

#include <memory>
#include <span>

#include "core/engine/fleet_software.hpp"
#include "core/engine/run_watch.hpp"
#include "core/outcome/law.hpp"
#include "core/outcome/outcome.hpp"
#include "core/outcome/trace.hpp"
#include "core/scenario/scenario.hpp"
#include "core/sdk/fleetproof/agent.h"

namespace fleetproof {

// One run: a pure function of scenario and control software.
//
// Laws observe the run. The violations in the outcome come from the first law; incidents and coverage come from all
// laws. Neither laws nor sink can change the trace. If an agent crashes or hangs, only its destroy() is called any
// more. Its AGV completes the actions that the agent has called for, and then stands; the run goes on. A bug of the
// engine ends the run: the outcome says `engine_error`. Every agent gets its config as its own parameters. Throws
// InputError as check_roles() does.
//
// `watch` tells which call into an agent is under way, leaves out calls that are known to end the process, and can
// abandon the run: then RunAbandoned is thrown.
// It can also record what the agents do, or play a recording in place of the agents: then the software is never called,
// and EngineError is thrown if the recording does not fit the run.
//
// Threads: any number of runs at once; one run stays on its thread.
Outcome simulate(const Scenario& scenario, const FleetSoftware& software, std::span<const std::unique_ptr<Law>> laws,
                 TraceSink* sink = nullptr, const RunWatch& watch = {});
// The same for a scenario without computers.
Outcome simulate(const Scenario& scenario, const fp_agent_type& agent, std::span<const std::unique_ptr<Law>> laws,
                 TraceSink* sink = nullptr, const char* agent_config = "", const RunWatch& watch = {});

// Throws InputError unless the agent speaks this host's ABI.
void check_abi(const fp_agent_type& agent);

}  // namespace fleetproof
