#pragma once

#include "core/base/random.hpp"
#include "core/scenario/layout.hpp"
#include "generators/families/range.hpp"

namespace fleetproof {

// Two diagonal cross aisles that rise from the middle of the front; picking aisles above them stand upright, those
// below lie flat (Gue and Meller). Goods are picked in the aisle: whoever picks closes it. Stress: diagonals of 20-30
// or 60-70 degrees, stations from 2.1 m apart, every aisle two-way.
Layout make_fishbone(Draws& draws, Range range);

}  // namespace fleetproof
