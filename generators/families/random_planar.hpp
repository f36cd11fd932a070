#pragma once

#include "core/base/random.hpp"
#include "core/scenario/layout.hpp"
#include "generators/families/range.hpp"

namespace fleetproof {

// Stations strewn at random, joined by a Gabriel graph with edges left out and directions drawn; what is not strongly
// connected is cut off. Lanes meet at every angle, and a station to wait at may lie in the middle of the traffic.
// Stress: 30-60 % of the edges left out, and lanes squeezed in beside others: acute angles below 30 degrees, and
// parallel lanes 1.2-1.5 m apart.
Layout make_random_planar(Draws& draws, Range range);

}  // namespace fleetproof
