#pragma once

#include "core/base/random.hpp"
#include "core/scenario/layout.hpp"
#include "generators/families/range.hpp"

namespace fleetproof {

// A grid of one-way lines, with spurs at its edge. The grid is so narrow that an AGV on one crossing is next to AGVs on
// all neighbouring crossings. Stress: lines 1-2 vehicle lengths apart, and a second grid over the first. Their lanes
// cross at places without a station.
Layout make_dense_crossing(Draws& draws, Range range);

}  // namespace fleetproof
