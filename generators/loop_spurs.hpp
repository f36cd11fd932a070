#pragma once

#include "core/layout.hpp"
#include "core/random.hpp"

namespace fleetproof {

// A one-way loop with rounded corners and spurs to both sides of it: whoever stands on the loop stops everybody behind.
Layout make_loop_spurs(Draws& draws);

}  // namespace fleetproof
