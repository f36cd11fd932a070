#pragma once

#include <memory>

#include "core/outcome/law.hpp"

namespace fleetproof {

// Accuses an AGV whose battery runs empty away from a charging station: the AGV then blocks its place for good. The law
// reads the records of the world (to the nanosecond) and the place of the AGV at that instant. It does not see an empty
// battery that the world does not record. The incident lasts until charging begins, until the operator changes the
// battery, or to the end of the run.
std::unique_ptr<Law> make_battery_law(const Scenario& scenario);

}  // namespace fleetproof
