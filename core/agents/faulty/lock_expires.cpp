// FAULT: 20 s after it locked, an AGV grants what it holds. Otherwise this agent is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.grants = {.locks_end_after_ns = 20 * kSecond_ns}};
}

constinit const fp_agent_type kLockExpires =
    faulty_hull_lock<kFault>("lock-expires", "hull-lock with a fault: lets its lock end after 20 s");

}  // namespace fleetproof::agents
