// FAULT: an AGV that was far away once is taken to be there still. Otherwise this agent is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.consent = {.proofs_age = false}};
}

constinit const fp_agent_type kAgelessProof =
    faulty_hull_lock<kFault>("ageless-proof", "hull-lock with a fault: ignores the age of a position");

}  // namespace fleetproof::agents
