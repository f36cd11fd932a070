// FAULT: a turn of less than 10 degrees is not in the hull. Otherwise this agent is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.hulls = {.small_turns_count = false}};
}

constinit const fp_agent_type kSmallTurnsFree =
    faulty_hull_lock<kFault>("small-turns-free", "hull-lock with a fault: locks no floor for turns below 10 degrees");

}  // namespace fleetproof::agents
