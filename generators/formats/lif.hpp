#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/layout.hpp"

namespace fleetproof {

// Reads a layout in the VDMA Layout Interchange Format (JSON, LIF 1.0 and the spellings of its successor). If a file
// has several layouts, the first is read. Nodes become stations, and edges become segments. Two edges there and back on
// one track become one bidirectional segment. Trajectories are NURBS: see cubic_pieces. A node is for storage if an AGV
// picks or drops on the node or on an edge that ends there. It is for charging if an AGV starts to charge there.
//
// `warnings` receives one sentence, with file and line, for everything that was left out, guessed or changed. Throws
// InputError with file, line, field, value and remedy if no AGV can drive on the layout.
Layout read_lif(const std::string& path, std::vector<std::string>& warnings);
Layout parse_lif(std::string_view text, std::string_view source, std::vector<std::string>& warnings);

// The layout as LIF 1.0. The format has no words for the purposes of a station, so they stand in the description of its
// node, where parse_lif finds them. Reading the text gives the same layout, with two exceptions: two one-way segments
// on one track become one segment (merge_antiparallel), and the floor is fitted again. A layout without segments cannot
// be read again.
std::string to_lif(const Layout& layout);

// The words for purposes in a description, as to_lif writes and parse_lif reads them: "purposes: storage charging".
inline constexpr std::string_view kPurposesMark = "purposes:";

}  // namespace fleetproof
