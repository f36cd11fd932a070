// FAULT: an AGV is taken to have gone on as between its last two positions. Otherwise this agent is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.consent = {.places_spread = false}};
}

constinit const fp_agent_type kStraightOn =
    faulty_hull_lock<kFault>("straight-on", "hull-lock with a fault: extrapolates positions");

}  // namespace fleetproof::agents
