#pragma once

#include <vector>

#include "core/scenario/layout.hpp"

namespace fleetproof {

// Where an AGV that has been taken off the floor may be set down again.
struct RecoveryPlace {
  StationId station;
  Pose pose;
};

// In order of preference. The first place is the station at which the AGV stood, with its heading there; if the AGV
// stood on a lane (`stopped_on`; null: on none), it is the end of that lane. The other agents expect the AGV at this
// place. Then come all stations to which the AGV could have driven from there, by length of the way; equals by number.
// The heading is the one with which the AGV would have arrived.
std::vector<RecoveryPlace> recovery_places(const LogicalMap& map, StationId station, const Lane* stopped_on,
                                           const Pose& stood);

}  // namespace fleetproof
