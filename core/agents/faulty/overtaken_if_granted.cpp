// FAULT: a request that grants a conflicting one begins a new epoch only if it has the other AGV's grant already.
// Otherwise this agent is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.grants = {.overtaken = Overtaken::StepsBackIfGranted}};
}

constinit const fp_agent_type kOvertakenIfGranted = faulty_hull_lock<kFault>(
    "overtaken-if-granted", "hull-lock with a fault: begins a new epoch only if it was granted");

}  // namespace fleetproof::agents
