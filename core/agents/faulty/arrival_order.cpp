// FAULT: the message that came last counts, not the one that was sent last. Otherwise this agent is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.consent = {.stamps_count = false}};
}

constinit const fp_agent_type kArrivalOrder =
    faulty_hull_lock<kFault>("arrival-order", "hull-lock with a fault: takes the last message to come for the newest");

}  // namespace fleetproof::agents
