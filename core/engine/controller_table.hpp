#pragma once

#include "core/sdk/fleetproof/agent.h"

namespace fleetproof {

// The functions that every agent is given.
extern const fp_host kHost;

}  // namespace fleetproof
