#pragma once

#include "core/base/random.hpp"
#include "core/scenario/layout.hpp"
#include "generators/families/range.hpp"

namespace fleetproof {

// A corridor that is one two-way lane, with parallel sidings to let others pass: the layout on which fleets lock each
// other out. Stress: 60-100 m with one siding or none.
Layout make_corridor_sidings(Draws& draws, Range range);

}  // namespace fleetproof
