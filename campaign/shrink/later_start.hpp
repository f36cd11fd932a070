#pragma once

#include "campaign/run/itinerary.hpp"
#include "core/scenario/scenario.hpp"

namespace fleetproof {

// Where an AGV starts that was between two stations.
enum class Between : bool { Behind, Ahead };

// A run of the scenario from `from` on: each AGV starts at a station where it was then, or between which it was, and
// has the transports that were not done. All instants come earlier by `from`. Loads under way have to be fetched again,
// so it is another run, which may fail as the whole one does. Requires: no AGV has a script.
Scenario with_later_start(const Scenario& scenario, const Itinerary& itinerary, Duration from, Between between);

}  // namespace fleetproof
