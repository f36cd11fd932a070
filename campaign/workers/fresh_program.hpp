#pragma once

#include <cstdint>
#include <string>

#include "campaign/plan/plan.hpp"
#include "campaign/run/agent_programs.hpp"
#include "campaign/workers/channel.hpp"
#include "campaign/workers/shared_slots.hpp"

namespace fleetproof {

// A worker that is a program of its own, started by `exec`. It has an address layout of its own, and shares nothing but
// the slots with the process that started it. The runs of an audit happen there.

// What such a worker must be told: the plan and the plug-ins. The first frame on its channel.
std::string encode_setup(const CampaignPlan& plan, const AgentPrograms& programs);

// Turns this process into the worker. `program`: a file whose main() calls serve_if_called. Standard streams and limits
// stay as they are. If that is not possible, the channel says so and the process ends.
[[noreturn]] void become_fresh_program(const std::string& program, const SharedSlots& slots, int slot, Channel channel);

// Call this first in main(). If become_fresh_program made this process, it takes orders and never returns.
void serve_if_called(int argc, const char* const* argv);

}  // namespace fleetproof
