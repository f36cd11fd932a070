#pragma once

#include "core/base/random.hpp"
#include "core/scenario/layout.hpp"
#include "generators/families/range.hpp"

namespace fleetproof {

// A one-way loop with rounded corners and spurs to both sides of it: whoever stands on the loop stops everybody behind.
// Stress: spurs of 0.9-1.5 m, shorter than a vehicle, which sticks out into the loop; chords across the loop that cross
// without a station.
Layout make_loop_spurs(Draws& draws, Range range);

}  // namespace fleetproof
