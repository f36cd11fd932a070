// FAULT: after a restart, requests have the numbers of earlier requests once more. Otherwise this agent is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {
constexpr LockOptions kFault{.consent = {.epochs_name_boot = false}};
}

constinit const fp_agent_type kForgetsBoot =
    faulty_hull_lock<kFault>("forgets-boot", "hull-lock with a fault: numbers its requests without the boot");

}  // namespace fleetproof::agents
