#pragma once

#include "core/base/random.hpp"
#include "core/scenario/layout.hpp"

namespace fleetproof {

// The stress range of aisle-grid: one cross aisle, from which 4-10 two-way aisles, 2.8-4 m apart, lead into dead ends.
// AGVs pick goods in the aisle. An AGV that picks therefore blocks its aisle, and two AGVs cannot pass each other
// there. Parking and charging stations are spurs before the cross aisle.
Layout make_dead_end_aisles(Draws& draws);

}  // namespace fleetproof
