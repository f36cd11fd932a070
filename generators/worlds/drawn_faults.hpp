#pragma once

#include "core/scenario/scenario.hpp"
#include "generators/worlds/fault_rates.hpp"

namespace fleetproof {

// Draws the faults of a scenario whose fleet and transports are final. A pure function of scenario, rates and `key`.
void draw_faults(Scenario& scenario, const FaultRates& rates, std::uint64_t key);

}  // namespace fleetproof
