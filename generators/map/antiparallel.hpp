#pragma once

#include <cstddef>

#include "core/scenario/layout.hpp"

namespace fleetproof {

// Merges two one-way segments that lead there and back between two stations on one track (control points mirrored, to
// within 1 mm). They become one bidirectional segment: the first in the list, which keeps its name. Returns the number
// of merged pairs.
std::size_t merge_antiparallel(Layout& layout);

}  // namespace fleetproof
