#pragma once

#include "core/scenario/lane_rules.hpp"
#include "laws/whereabouts.hpp"

namespace fleetproof {

// The first lane of a shortest way from one station to another for which the AGV has permission; null if there is no
// way, or if both are one station.
const Lane* first_lane_of_way(const LaneRules& rules, StationId from, StationId to);

// The station at which a body stands; invalid if the body stands at no station.
StationId station_of(const LogicalMap& map, const Vec2& position_m);

// The first resting body in the way of `agv` along `lane`: it is closer than the safety distance to what the AGV would
// sweep. Invalid if there is none.
EntityId first_in_the_way(const Scenario& scenario, const Whereabouts& bodies, EntityId agv, const Lane& lane,
                          SimTime now);

}  // namespace fleetproof
