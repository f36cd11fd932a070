#pragma once

#include <span>

#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::agents {

// hull-lock with one planted fault each. The fault stands above its line of the table.
extern const std::span<const fp_agent_type> kFaultyAgents;

}  // namespace fleetproof::agents
