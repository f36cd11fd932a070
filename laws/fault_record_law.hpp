#pragma once

#include <memory>

#include "core/outcome/law.hpp"

namespace fleetproof {

// Accuses nothing. It files what the scenario did to the fleet: each fault that struck an AGV (FaultInjected, to the
// end of the fault), and each fallen load or obstacle while it lay on the floor (ForeignBody). A report says from them
// what came before a failure. An obstacle that is there from the start is not filed: it comes before everything. And it
// files what the scenario asked for and did not get: faults that changed nothing, loads that could not fall, obstacles
// that found no room, calls of a script that were refused, not played or found no load, messages that were never sent,
// and what the end of the run came before.
std::unique_ptr<Law> make_fault_record_law(const Scenario& scenario);

}  // namespace fleetproof
