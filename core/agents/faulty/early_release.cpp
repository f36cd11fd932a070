// FAULT: a lane is released 2 s before its end. Otherwise this agent is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.holding = {.lanes_to_their_end = false}};
}

constinit const fp_agent_type kEarlyRelease =
    faulty_hull_lock<kFault>("early-release", "hull-lock with a fault: releases a lane 2 s before its end");

}  // namespace fleetproof::agents
