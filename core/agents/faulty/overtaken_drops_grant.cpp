// FAULT: a request that grants a conflicting one gives back the other AGV's grant, but begins no new epoch. Otherwise
// this agent is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.grants = {.overtaken = Overtaken::DropsThatGrant}};
}

constinit const fp_agent_type kOvertakenDropsGrant = faulty_hull_lock<kFault>(
    "overtaken-drops-grant", "hull-lock with a fault: gives back a grant instead of beginning a new epoch");

}  // namespace fleetproof::agents
