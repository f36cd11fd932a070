// FAULT: two paths conflict only if they share a station. Otherwise this agent is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.hulls = {.shapes_decide = false}};
}

constinit const fp_agent_type kNamesNotShapes =
    faulty_hull_lock<kFault>("names-not-shapes", "hull-lock with a fault: compares stations, not shapes");

}  // namespace fleetproof::agents
