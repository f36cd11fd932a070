#pragma once

#include "core/scenario/scenario.hpp"

namespace fleetproof {

// Whether a scenario can be simulated and is a fair test: its fields have sense, no AGV starts too close to another
// body, all can drive off, and each transport has a way. A failure of any other scenario says nothing.
bool is_fair(const Scenario& scenario);

}  // namespace fleetproof
