#pragma once

#include "core/layout.hpp"
#include "core/random.hpp"

namespace fleetproof {

// A corridor that is one two-way lane, with parallel sidings to let others pass: the layout on which fleets lock each other out.
Layout make_corridor_sidings(Draws& draws);

}  // namespace fleetproof
