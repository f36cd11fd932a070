#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/layout.hpp"

namespace fleetproof {

// Reads a layout in the VDMA Layout Interchange Format (JSON, LIF 1.0 and the spellings of its successor). Of several
// layouts in a file the first is taken. Nodes become stations, edges segments; the two edges of one track, back and
// forth, become one bidirectional segment. Trajectories are NURBS: see cubic_pieces. A node is for storage where an AGV
// picks or drops, for charging where it starts to charge, on the node or on an edge that ends there.
//
// `warnings` receives one sentence, with file and line, for all that was left out, guessed or changed. InputError with
// file, line, field, value and remedy where the layout cannot be driven on.
Layout read_lif(const std::string& path, std::vector<std::string>& warnings);
Layout parse_lif(std::string_view text, std::string_view source, std::vector<std::string>& warnings);

// The layout as LIF 1.0. What the format has no words for, the purposes of a station, is told in the description of its
// node, which parse_lif understands; so that reading it gives the same layout again, with two exceptions: two one-way
// segments on one track come back as one (merge_antiparallel), and the floor is fitted anew. A layout without segments
// is not read again.
std::string to_lif(const Layout& layout);

// The words for purposes in a description, as to_lif writes and parse_lif reads them: "purposes: storage charging".
inline constexpr std::string_view kPurposesMark = "purposes:";

}  // namespace fleetproof
