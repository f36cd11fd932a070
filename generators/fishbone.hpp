#pragma once

#include "core/layout.hpp"
#include "core/random.hpp"

namespace fleetproof {

// Two diagonal cross aisles that rise from the middle of the front; picking aisles above them stand upright, those below lie flat
// (Gue and Meller). Goods are picked in the aisle: whoever picks closes it.
Layout make_fishbone(Draws& draws);

}  // namespace fleetproof
