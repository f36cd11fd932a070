// FAULT: of two AGVs that request the same floor, each lets the other go first. Otherwise this agent is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.progress = {.order_is_common = false}};
}

constinit const fp_agent_type kBothStepBack = faulty_hull_lock<kFault>(
    "both-step-back", "hull-lock with a fault: of two requests, each AGV lets the other go first");

}  // namespace fleetproof::agents
