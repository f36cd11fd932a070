// FAULT: after a restart at rest, an AGV grants everything until it knows its heading. Otherwise this agent is
// hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.grants = {.unknown_place_defers = false}};
}

constinit const fp_agent_type kGrantsAtBoot =
    faulty_hull_lock<kFault>("grants-at-boot", "hull-lock with a fault: grants everything right after a restart");

}  // namespace fleetproof::agents
