// FAULT: a turn on the spot is not in the hull. Otherwise this agent is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.hulls = {.turns_count = false}};
}

constinit const fp_agent_type kNoTurnSweep =
    faulty_hull_lock<kFault>("no-turn-sweep", "hull-lock with a fault: locks no floor for turns on the spot");

}  // namespace fleetproof::agents
