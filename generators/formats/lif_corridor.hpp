#pragma once

#include <vector>

#include "generators/text/json_value.hpp"

namespace fleetproof {

// How wide the corridors of an edge of LIF are, in metres: the widest of all rules, at most kWidestFloor_m; 0 without a
// corridor. Throws InputError if a width is below 0.
double corridor_width_m(const std::vector<JsonReader>& rules);

}  // namespace fleetproof
