#pragma once

#include "core/sdk/fleetproof/agent.h"

namespace fleetproof {

// The functions that the agents of a plug-in are given, and those of a run that is recorded. Each refuses a call that
// does not come from the thread on which the agent is called, computes with the engine's state of the processor, writes
// the call on the tape, if there is one, and passes it on to kHost. Their fp_controller is a ForeignHandle.
extern const fp_host kForeignHost;

}  // namespace fleetproof
