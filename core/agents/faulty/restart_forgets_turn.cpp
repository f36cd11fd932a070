// FAULT: a restarted AGV holds the lane that it drives, but not the turn before it. Otherwise this agent is hull-
// lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.holding = {.turns_over_restarts = false}};
}

constinit const fp_agent_type kRestartForgetsTurn =
    faulty_hull_lock<kFault>("restart-forgets-turn", "hull-lock with a fault: forgets at a restart that it turns");

}  // namespace fleetproof::agents
