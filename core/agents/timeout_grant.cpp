// FAULT: an AGV that has not answered for 3 s counts as having granted. Otherwise this agent is hull-lock.
#include "core/agents/agent_type.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {

constinit const fp_agent_type kTimeoutGrant = agent_type<HullLock>(
    "timeout-grant", "hull-lock with a fault: takes 3 s of silence for consent",
    [](const fp_host* host, fp_controller* controller, const fp_briefing* briefing) {
      return create_hull_lock(host, controller, briefing, {.silence_consents_after_ns = 3 * kSecond_ns});
    });

}  // namespace fleetproof::agents
