#pragma once

#include "core/base/random.hpp"
#include "core/scenario/layout.hpp"
#include "generators/families/range.hpp"

namespace fleetproof {

// A corridor with one two-way lane. AGVs let others pass on parallel sidings. On this layout, AGVs easily block each
// other. Stress: 60-100 m with one siding or none.
Layout make_corridor_sidings(Draws& draws, Range range);

}  // namespace fleetproof
