// FAULT: an AGV that stands grants the floor under it. Otherwise this agent is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.grants = {.bodies_count = false}};
}

constinit const fp_agent_type kIgnoresParked =
    faulty_hull_lock<kFault>("ignores-parked", "hull-lock with a fault: holds no floor while it stands");

}  // namespace fleetproof::agents
