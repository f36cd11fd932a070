#pragma once

#include "core/sdk/fleetproof/agent.h"

namespace fleetproof {

// Control software that only sends and listens: 64 bytes to everybody every 300 ms, and all messages taken from the
// inbox. The AGV stands. What remains is the cost of the engine.
extern const fp_agent_type kNullAgent;

}  // namespace fleetproof
