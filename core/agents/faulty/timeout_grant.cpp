// FAULT: an AGV that has not answered for 3 s counts as having granted. Otherwise this agent is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.consent = {.silence_consents_after_ns = 3 * kSecond_ns}};
}

constinit const fp_agent_type kTimeoutGrant =
    faulty_hull_lock<kFault>("timeout-grant", "hull-lock with a fault: takes 3 s of silence for consent");

}  // namespace fleetproof::agents
