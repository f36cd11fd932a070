#pragma once

#include "core/layout.hpp"
#include "core/random.hpp"

namespace fleetproof {

// Aisles between two or three cross aisles; storage bays are short spurs off the aisles, so that a picking AGV does not block the aisle.
Layout make_aisle_grid(Draws& draws);

}  // namespace fleetproof
