// FAULT: of two AGVs that block each other, both make way at the same time. Otherwise this agent is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.progress = {.elder_stays = false}};
}

constinit const fp_agent_type kBothMakeWay =
    faulty_hull_lock<kFault>("both-make-way", "hull-lock with a fault: makes way for everybody");

}  // namespace fleetproof::agents
