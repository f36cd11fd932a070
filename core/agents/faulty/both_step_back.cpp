// FAULT: an AGV whose request is blocked gives way to every request, also to a blocked one. Otherwise this agent is
// hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.progress = {.order_is_common = false}};
}

constinit const fp_agent_type kBothStepBack = faulty_hull_lock<kFault>(
    "both-step-back", "hull-lock with a fault: does not look whether the other request is blocked");

}  // namespace fleetproof::agents
