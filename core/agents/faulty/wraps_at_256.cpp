// FAULT: the number of a request has eight bits. Otherwise this agent is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.consent = {.epochs_grow = false}};
}

constinit const fp_agent_type kWrapsAt256 =
    faulty_hull_lock<kFault>("wraps-at-256", "hull-lock with a fault: numbers its requests modulo 256");

}  // namespace fleetproof::agents
