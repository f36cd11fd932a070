#pragma once

#include <string>

#include "campaign/plan/plan.hpp"
#include "campaign/run/agent_programs.hpp"
#include "campaign/workers/forker.hpp"
#include "campaign/workers/shared_slots.hpp"
#include "campaign/workers/worker_logs.hpp"

namespace fleetproof {

// With this exit code a worker says that it could not answer.
inline constexpr int kChannelClosedExit = 97;

// This program, of which main() begins with serve_if_called.
inline constexpr const char* kThisProgram = "/proc/self/exe";

// What a worker is started with.
WorkerProgram worker_program(const SharedSlots& slots, const WorkerLogs& logs);

// What it must be told then, the first frame on its channel: the plan and the plug-ins, which it loads.
std::string encode_setup(const CampaignPlan& plan, const AgentPrograms& programs);

// Call this first in main(). If a Forker, or a process that one has made, has started this process, it serves and never
// returns: as a forker or as a worker, which takes one order after the other until its channel is closed.
void serve_if_called(int argc, const char* const* argv);

}  // namespace fleetproof
