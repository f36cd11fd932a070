// FAULT: an AGV whose way keeps clear need not have heard of the request. Otherwise this agent is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.consent = {.ways_are_heard = false}};
}

constinit const fp_agent_type kUnheardWay =
    faulty_hull_lock<kFault>("unheard-way", "hull-lock with a fault: counts on ways before its own has been heard");

}  // namespace fleetproof::agents
