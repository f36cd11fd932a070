// FAULT: the hull of a turn on the spot reaches half the length of the body, not half the diagonal. Otherwise this
// agent is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.hulls = {.corners_count = false}};
}

constinit const fp_agent_type kNoHalfDiagonal =
    faulty_hull_lock<kFault>("no-half-diagonal", "hull-lock with a fault: leaves out the corners of a body that turns");

}  // namespace fleetproof::agents
