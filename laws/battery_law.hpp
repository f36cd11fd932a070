#pragma once

#include <memory>

#include "core/outcome/law.hpp"

namespace fleetproof {

// Accuses an AGV whose battery runs empty anywhere but at a charging station: it stands on the track for good. Reads
// what the world records (to the nanosecond) and where the AGV is at that instant; an empty battery that the world does
// not record, it does not see. The incident lasts until charging begins, or to the end of the run.
std::unique_ptr<Law> make_battery_law(const Scenario& scenario);

}  // namespace fleetproof
