// FAULT: a restarted AGV holds the station where it was, not the lane that it drives. Otherwise this agent is
// hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.holding = {.lanes_over_restarts = false}};
}

constinit const fp_agent_type kRestartForgetsLane =
    faulty_hull_lock<kFault>("restart-forgets-lane", "hull-lock with a fault: forgets at a restart what it drives");

}  // namespace fleetproof::agents
