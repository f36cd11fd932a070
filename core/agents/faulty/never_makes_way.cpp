// FAULT: an AGV never leaves a place that others need. Otherwise this agent is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.progress = {.makes_way = false}};
}

constinit const fp_agent_type kNeverMakesWay =
    faulty_hull_lock<kFault>("never-makes-way", "hull-lock with a fault: makes way for nobody");

}  // namespace fleetproof::agents
