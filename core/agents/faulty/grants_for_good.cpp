// FAULT: an AGV that granted one request grants all later requests of the same AGV. Otherwise this agent is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.grants = {.grants_name_epoch = false}};
}

constinit const fp_agent_type kGrantsForGood = faulty_hull_lock<kFault>(
    "grants-for-good", "hull-lock with a fault: grants all requests of an AGV once it has granted one");

}  // namespace fleetproof::agents
