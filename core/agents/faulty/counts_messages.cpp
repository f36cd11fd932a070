// FAULT: a second GRANT of the same AGV counts as that of another AGV. Otherwise this agent is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.consent = {.senders_count = false}};
}

constinit const fp_agent_type kCountsMessages =
    faulty_hull_lock<kFault>("counts-messages", "hull-lock with a fault: counts messages, not senders");

}  // namespace fleetproof::agents
