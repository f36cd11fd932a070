#pragma once

#include "core/base/random.hpp"
#include "core/scenario/layout.hpp"
#include "generators/families/range.hpp"

namespace fleetproof {

// A ring of two lanes side by side. Each bar stands on one of them and ends beside the other one, which bends and kinks
// there. AGVs turn in the bars, back into them, or back out of them. Stress: the end of a bar is as far from the
// lane as a body of some size needs that passes, or less; bars are as near to each other as two bodies.
Layout make_close_pass(Draws& draws, Range range);

}  // namespace fleetproof
