#pragma once

#include "core/bridges/vda5050/documents.hpp"
#include "core/bridges/vda5050/order_check.hpp"
#include "core/sdk/fleetproof/agent.h"

// What the built-in vehicle can do and is, as it follows from its vehicle type.
namespace fleetproof::bridges::vda5050 {

// pick and drop with a loadId, which is the number of a transport, and startCharging: at nodes, as HARD actions.
Abilities vehicle_abilities();

Factsheet factsheet_of(const fp_agv& vehicle, const char* type_name);

}  // namespace fleetproof::bridges::vda5050
