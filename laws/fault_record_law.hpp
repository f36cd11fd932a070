#pragma once

#include <memory>

#include "core/outcome/law.hpp"

namespace fleetproof {

// Accuses nothing. It files what the scenario did to the fleet: each fault that struck an AGV (FaultInjected, to the
// end of the fault), and each fallen load or obstacle while it lay on the floor (ForeignBody). A report says from them
// what came before a failure. An obstacle that is there from the start is not filed: it comes before everything.
std::unique_ptr<Law> make_fault_record_law(const Scenario& scenario);

}  // namespace fleetproof
