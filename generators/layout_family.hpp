#pragma once

#include <span>

#include "core/catalogue.hpp"
#include "core/layout.hpp"
#include "core/random.hpp"

namespace fleetproof {

// Invents a layout: strongly connected, and with room for the default vehicle type (1.6 m x 1.0 m) to turn at every station. Stations
// are at least 2.1 m apart; one where an AGV may wait (parking, charging, storage) is at least 2.2 m from every lane of which it is no end.
using MakeLayout = Layout (*)(Draws& draws);

std::span<const Entry<MakeLayout>> layout_families();

// InputError with a hint if there is no such family.
const Entry<MakeLayout>& layout_family(std::string_view name);

}  // namespace fleetproof
