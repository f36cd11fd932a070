// FAULT: of two demands of the same age, neither comes first. Otherwise this agent is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.progress = {.smaller_number_first = false}};
}

constinit const fp_agent_type kTieWithoutNumber =
    faulty_hull_lock<kFault>("tie-without-number", "hull-lock with a fault: has no rule for demands of the same age");

}  // namespace fleetproof::agents
