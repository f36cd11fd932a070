#pragma once

#include "core/scenario/scenario.hpp"
#include "generators/worlds/computer_faults.hpp"
#include "generators/worlds/fault_rates.hpp"

namespace fleetproof {

// Draws the faults of a scenario whose fleet and transports are final. A pure function of scenario, rates and `key`.
void draw_faults(Scenario& scenario, const FaultRates& rates, std::uint64_t key);

// Draws the faults of a computer of the scenario, behind those that are there. A function of horizon, place of the
// computer (ComputerSetup::draws_as), rates and `key` alone.
void draw_computer_faults(Scenario& scenario, EntityId computer, const ComputerFaultRates& rates, std::uint64_t key);

}  // namespace fleetproof
