// FAULT: a GRANT counts for whatever request is open, even if it answers an earlier one. Otherwise this agent is
// hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.consent = {.answers_name_epoch = false}};
}

constinit const fp_agent_type kStaleGrant = faulty_hull_lock<kFault>(
    "stale-grant", "hull-lock with a fault: takes a grant for an earlier request as one for this request");

}  // namespace fleetproof::agents
