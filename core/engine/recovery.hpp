#pragma once

#include <vector>

#include "core/scenario/layout.hpp"

namespace fleetproof {

// Where an AGV that has been taken off the floor may be set down again.
struct RecoveryPlace {
  StationId station;
  Pose pose;
};

// In order of preference: the station at which the AGV stood, as it stood there, or the end of the lane on which it
// stood (`stopped_on`; null: on none); then every other station to which it could have driven from there, by length of
// the way, of equals by number, with the heading with which it would have arrived. The first is where the others expect
// it: it was there, or on its way there.
std::vector<RecoveryPlace> recovery_places(const LogicalMap& map, StationId station, const Lane* stopped_on,
                                           const Pose& stood);

}  // namespace fleetproof
