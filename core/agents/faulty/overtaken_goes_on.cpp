// FAULT: a request that has granted a conflicting one goes on as if it had not. Otherwise this agent is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.grants = {.overtaken = Overtaken::GoesOn}};
}

constinit const fp_agent_type kOvertakenGoesOn =
    faulty_hull_lock<kFault>("overtaken-goes-on", "hull-lock with a fault: does not begin a new epoch after a grant");

}  // namespace fleetproof::agents
