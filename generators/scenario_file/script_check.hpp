#pragma once

#include "core/scenario/scenario.hpp"
#include "generators/map/problem.hpp"

namespace fleetproof {

// What an AGV cannot do of its script, whatever happens in the run. Only of the first call it is known where the AGV
// is.
void check_script(const Scenario& scenario, std::size_t agv, Problems& problems);

}  // namespace fleetproof
