#pragma once

#include <span>

#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::agents {

struct FaultyAgent {
  const fp_agent_type* sound;  // what it is but for its fault
  fp_agent_type type;
};

// Each with one planted fault, which stands above its line of the table.
extern const std::span<const FaultyAgent> kFaultyAgents;

}  // namespace fleetproof::agents
