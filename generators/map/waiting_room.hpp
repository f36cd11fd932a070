#pragma once

#include <vector>

#include "core/scenario/layout.hpp"
#include "generators/map/reachability.hpp"

namespace fleetproof {

// A place to wait is a station for parking, charging or storage.
bool is_place_to_wait(const Station& station);

// By station: whether it is a cut station. An AGV that stands at a cut station divides the rest of the core. An example
// is the end of a two-way lane that is the only way to some part of the map. False for stations outside the core.
std::vector<bool> cut_stations(const LogicalMap& map, const Reachability& reachability);

// Whether the core has a place to wait that does not divide it.
bool has_open_waiting_place(const LogicalMap& map, const Reachability& reachability);

// Moves the purposes of every open place to wait to the nearest cut station without a purpose, storage first; if none
// is left, the place loses them. Every AGV that waits is then in the way of others. Returns false and changes nothing
// if fewer than two storage stations would remain.
bool close_waiting_places(Layout& layout);

}  // namespace fleetproof
