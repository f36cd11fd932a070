// FAULT: the hull of a lane is that of the straight line between its stations. Otherwise this agent is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.hulls = {.bends_count = false}};
}

constinit const fp_agent_type kBendsAsChords =
    faulty_hull_lock<kFault>("bends-as-chords", "hull-lock with a fault: takes every bend as its chord");

}  // namespace fleetproof::agents
