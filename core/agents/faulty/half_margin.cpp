// FAULT: hulls keep half the safety distance. Otherwise this agent is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.hulls = {.margin_is_whole = false}};
}

constinit const fp_agent_type kHalfMargin =
    faulty_hull_lock<kFault>("half-margin", "hull-lock with a fault: keeps half the safety distance");

}  // namespace fleetproof::agents
