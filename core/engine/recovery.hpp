#pragma once

#include <vector>

#include "core/scenario/lane_rules.hpp"

namespace fleetproof {

// Where an AGV that has been taken off the floor may be set down again.
struct RecoveryPlace {
  StationId station;
  Pose pose;
};

// In order of preference. The first place is the station at which the AGV stood, with its heading there; if the AGV
// stood on a lane (`stopped_on`; null: on none), it is the end of that lane. The other agents expect the AGV at this
// place. Then come all stations to which lanes lead from there, by length of the way; equals by number. The operator
// pushes the AGV, so that no permission counts on the way. The heading is the one that the station demands, otherwise
// the one with which the AGV would have arrived. Places with lanes are left out if the rules let such an AGV drive off
// by none.
std::vector<RecoveryPlace> recovery_places(const LaneRules& rules, StationId station, const Lane* stopped_on,
                                           const Pose& stood);

}  // namespace fleetproof
