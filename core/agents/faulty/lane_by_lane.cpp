// FAULT: an AGV locks one lane at a time. Otherwise this agent is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.progress = {.whole_stretches = false}};
}

constinit const fp_agent_type kLaneByLane =
    faulty_hull_lock<kFault>("lane-by-lane", "hull-lock with a fault: locks one lane at a time");

}  // namespace fleetproof::agents
