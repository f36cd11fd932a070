// FAULT: two bodies of one size are taken for the same, wherever their reference points are. Otherwise this agent
// is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.hulls = {.centres_differ = false}};
}

constinit const fp_agent_type kKindsBySize =
    faulty_hull_lock<kFault>("kinds-by-size", "hull-lock with a fault: knows bodies by their size alone");

}  // namespace fleetproof::agents
