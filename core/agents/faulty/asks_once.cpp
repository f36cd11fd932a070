// FAULT: a REQUEST is never sent again. Otherwise this agent is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.progress = {.asks_again = false}};
}

constinit const fp_agent_type kAsksOnce =
    faulty_hull_lock<kFault>("asks-once", "hull-lock with a fault: never repeats a request");

}  // namespace fleetproof::agents
