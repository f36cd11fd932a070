#pragma once

#include "core/sdk/fleetproof/agent.h"

namespace fleetproof {

// The functions that every agent is given while the run is recorded: each writes the call on the tape of the controller
// and passes it on to kHost. A run that is not recorded pays nothing for them.
extern const fp_host kRecordingHost;

}  // namespace fleetproof
