#pragma once

#include <cstddef>

#include "core/scenario/layout.hpp"

namespace fleetproof {

// Two one-way segments that lead back and forth between two stations on one track (control points mirrored, to within 1
// mm) become one bidirectional segment: the first of them in the list, which keeps its name. Answers how many pairs
// there were.
std::size_t merge_antiparallel(Layout& layout);

}  // namespace fleetproof
