#pragma once

#include "core/base/random.hpp"
#include "core/scenario/layout.hpp"
#include "generators/families/range.hpp"

namespace fleetproof {

// Stations at random places. A Gabriel graph joins them; some edges are left out, and directions are drawn. Only the
// strongly connected part is kept. Lanes meet at all angles, and a place to wait may lie in the middle of the traffic.
// Stress: 30-60 % of the edges are left out. Lanes are added close to others, with angles below 30 degrees, or in
// parallel at 1.2-1.5 m.
Layout make_random_planar(Draws& draws, Range range);

}  // namespace fleetproof
