// The family of aisle grids; some have aisles with a dead end.
#pragma once

#include "core/base/random.hpp"
#include "core/scenario/layout.hpp"
#include "generators/families/range.hpp"

namespace fleetproof {

// Aisles between two or three cross aisles; storage bays are short spurs off the aisles, so that a picking AGV does not
// block the aisle. Stress: one cross aisle, and aisles that end dead.
Layout make_aisle_grid(Draws& draws, Range range);

}  // namespace fleetproof
