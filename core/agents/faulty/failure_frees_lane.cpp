// FAULT: an AGV that is out of order releases the lane on which it stopped. Otherwise this agent is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.holding = {.lanes_over_failures = false}};
}

constinit const fp_agent_type kFailureFreesLane =
    faulty_hull_lock<kFault>("failure-frees-lane", "hull-lock with a fault: releases its lane when it breaks down");

}  // namespace fleetproof::agents
