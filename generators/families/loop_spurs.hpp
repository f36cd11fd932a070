#pragma once

#include "core/base/random.hpp"
#include "core/scenario/layout.hpp"
#include "generators/families/range.hpp"

namespace fleetproof {

// A one-way loop with rounded corners, and spurs on both sides. An AGV that stands on the loop stops all AGVs behind
// it. Stress: about half of the spurs have 0.9-1.5 m. They are shorter than a vehicle, so that it extends into the
// loop. Chords cross the loop and each other without a station.
Layout make_loop_spurs(Draws& draws, Range range);

}  // namespace fleetproof
