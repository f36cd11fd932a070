// FAULT: hulls have the size of the AGV without a load. Otherwise this agent is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.hulls = {.loads_count = false}};
}

constinit const fp_agent_type kNoOverhang =
    faulty_hull_lock<kFault>("no-overhang", "hull-lock with a fault: leaves out what a load adds to its vehicle");

}  // namespace fleetproof::agents
