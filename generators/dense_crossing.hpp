#pragma once

#include "core/layout.hpp"
#include "core/random.hpp"

namespace fleetproof {

// A grid of one-way lines so narrow that an AGV on one crossing is next to those on all crossings around it; spurs at the rim.
Layout make_dense_crossing(Draws& draws);

}  // namespace fleetproof
