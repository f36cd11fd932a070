#pragma once

#include "core/base/random.hpp"
#include "core/scenario/layout.hpp"
#include "generators/families/range.hpp"

namespace fleetproof {

// A grid of one-way lines so narrow that an AGV on one crossing is next to those on all crossings around it; spurs at
// the rim. Stress: lines 1-2 vehicle lengths apart, and a second grid laid over the first whose lanes cross it where
// neither has a station.
Layout make_dense_crossing(Draws& draws, Range range);

}  // namespace fleetproof
