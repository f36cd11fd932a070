// FAULT: hulls have the body on the wrong side of its reference point where an AGV drives backward. Otherwise this
// agent is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.hulls = {.directions_count = false}};
}

constinit const fp_agent_type kBackwardAsForward = faulty_hull_lock<kFault>(
    "backward-as-forward", "hull-lock with a fault: takes backward driving for forward driving");

}  // namespace fleetproof::agents
