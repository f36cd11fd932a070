// FAULT: every other AGV is taken to be as large as this one. Otherwise this agent is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.hulls = {.sizes_differ = false}};
}

constinit const fp_agent_type kOneSizeForAll =
    faulty_hull_lock<kFault>("one-size-for-all", "hull-lock with a fault: takes all AGVs to be as large as itself");

}  // namespace fleetproof::agents
