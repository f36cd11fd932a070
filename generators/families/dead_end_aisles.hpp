#pragma once

#include "core/base/random.hpp"
#include "core/scenario/layout.hpp"

namespace fleetproof {

// The stress range of aisle-grid: one cross aisle, from which 4-10 two-way aisles, 2.8-4 m apart, lead into dead ends.
// Goods are picked in the aisle, so whoever picks closes it, and two who meet in it cannot pass. Parking and charging
// are spurs before the cross aisle.
Layout make_dead_end_aisles(Draws& draws);

}  // namespace fleetproof
