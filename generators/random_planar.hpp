#pragma once

#include "core/layout.hpp"
#include "core/random.hpp"

namespace fleetproof {

// Stations strewn at random, joined by a Gabriel graph with edges left out and directions drawn; what is not strongly connected is cut
// off. Lanes meet at every angle, and a station to wait at may lie in the middle of the traffic.
Layout make_random_planar(Draws& draws);

}  // namespace fleetproof
