#pragma once

#include "core/clearance/clearance_over_time.hpp"

namespace fleetproof {

// True only if two bodies stay farther apart than this over a common interval of their pieces; most that do so, do so
// plainly. It costs less than one step of the search for the clearance over time.
bool surely_apart(const Piece& a, const Piece& b, Interval within, double distance_m);

}  // namespace fleetproof
