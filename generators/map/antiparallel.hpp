#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/scenario/layout.hpp"

namespace fleetproof {

// Two one-way segments there and back on one track stay two segments, or become one bidirectional segment.
enum class TwinPaths : std::uint8_t { Keep, Merge };

// Names of segments.
struct MergedTwins {
  std::vector<std::string> names;
  std::vector<std::string> in_other_blocks;  // those of which one direction was in a block, and the other was not
};

// Merges two one-way segments that lead there and back between two stations on one track (control points mirrored, to
// within 1 mm) with the same permissions. They become one bidirectional segment: the first in the list, which keeps its
// name and gets the blocks of both.
MergedTwins merge_antiparallel(Layout& layout);

// The same of these pairs of segments alone, there and back, by index. A pair that is no such twin stays as it is.
void merge_pairs(Layout& layout, const std::vector<std::pair<std::size_t, std::size_t>>& pairs);

// The same as merge_antiparallel if `twins` asks for it. `warnings` receives a sentence on such segments, and one on
// segments that lie on one track with another one and stay: both lead the same way, one is bidirectional, or other AGVs
// may drive it.
void settle_twins(Layout& layout, TwinPaths twins, std::string_view source, std::vector<std::string>& warnings);

}  // namespace fleetproof
