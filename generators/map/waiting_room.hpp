#pragma once

#include <vector>

#include "core/scenario/layout.hpp"
#include "generators/map/reachability.hpp"

namespace fleetproof {

// A place to wait is a station to park, charge or store at.
bool is_place_to_wait(const Station& station);

// By station of the core: whether the rest of the core falls apart when an AGV stands here and lets nobody through, as
// on an end of a two-way lane that is the only way to some part of the map. Stations outside the core count as false.
std::vector<bool> cut_stations(const LogicalMap& map, const Reachability& reachability);

// Whether a place to wait in the core cuts nobody off.
bool has_open_waiting_place(const LogicalMap& map, const Reachability& reachability);

// Moves the purposes of every open place to wait to the nearest cut station that has none, storage first: whoever waits
// is then in somebody's way. False, and nothing changed, if that leaves fewer than two places of storage.
bool close_waiting_places(Layout& layout);

}  // namespace fleetproof
