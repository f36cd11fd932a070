#pragma once

#include <cstdint>

#include "core/scenario.hpp"
#include "generators/reachability.hpp"
#include "generators/rejection_counts.hpp"

namespace fleetproof {

// Puts `fleet_size` AGVs of the scenario's first vehicle type on different stations from which all others can be reached, places to
// park, charge or store first, each heading along a lane that leaves its station. `key` is that of the placement stream, `attempt`
// its topic; an AGV's draws do not depend on the AGVs after it. False if there is no room; then `scenario.agvs` is as far as it got.
bool place_fleet(Scenario& scenario, std::uint32_t fleet_size, const Reachability& reachability, std::uint64_t key, std::uint32_t attempt,
                 RejectionCounts& counts);

}  // namespace fleetproof
