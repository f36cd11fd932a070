#pragma once

#include "laws/whereabouts.hpp"

namespace fleetproof {

// The first lane of a shortest way from one station to another; null if there is none, or it is no way at all.
const Lane* first_lane_of_way(const LogicalMap& map, StationId from, StationId to);

// The station at which a body stands; invalid if it stands at none.
StationId station_of(const LogicalMap& map, const Vec2& position_m);

// The body at rest that comes first in the way of `agv` along `lane`, closer than the safety distance to what the AGV
// would sweep; invalid if none does.
EntityId first_in_the_way(const Scenario& scenario, const Whereabouts& bodies, EntityId agv, const Lane& lane,
                          SimTime now);

}  // namespace fleetproof
