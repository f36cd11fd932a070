#pragma once

#include "core/sdk/fleetproof/agent.h"

// The built-in programs that speak VDA 5050.
namespace fleetproof::bridges::vda5050 {

// vda5050-master: for a computer; the decisions of zone-server.
extern const fp_agent_type kMaster;
// vda5050: for AGVs; a master leads it.
extern const fp_agent_type kVehicle;

}  // namespace fleetproof::bridges::vda5050
