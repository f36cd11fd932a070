#pragma once

#include <optional>

#include "core/clearance/clearance_over_time.hpp"

namespace fleetproof {

// A part of a common interval of two pieces outside which the bodies stay farther apart than this; nothing if they do
// so all the time and it is plain, as it mostly is. It costs less than a few steps of the search for the clearance over
// time.
std::optional<Interval> near_part(const Piece& a, const Piece& b, Interval within, double distance_m);

}  // namespace fleetproof
