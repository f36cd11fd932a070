// Layouts in LIF (VDMA): reading one of the layouts of a file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/layout.hpp"
#include "generators/formats/read_choice.hpp"

namespace fleetproof {

// Reads a layout in the VDMA Layout Interchange Format (JSON, LIF 1.0 and the spellings of its successor). Of several
// layouts in a file, the choice names one. Nodes become stations, and edges become segments. Two edges there and back
// on one track become one bidirectional segment. Trajectories are NURBS: see cubic_pieces. A node is for storage if an
// AGV picks or drops on the node or on an edge that ends there. It is for charging if an AGV starts to charge there.
//
// `warnings` receives one sentence, with file and line, for everything that was left out, guessed or changed. Throws
// InputError with file, line, field, value and remedy if no AGV can drive on the layout.
Layout read_lif(const std::string& path, std::vector<std::string>& warnings, const ReadChoice& choice = {});
Layout parse_lif(std::string_view text, std::string_view source, std::vector<std::string>& warnings,
                 const ReadChoice& choice = {});

// The words for purposes in a description, as to_lif writes and parse_lif reads them: "purposes: storage charging".
inline constexpr std::string_view kPurposesMark = "purposes:";

// The same for the edge that is the way back of a two-way segment: "back of: NAME".
inline constexpr std::string_view kBackMark = "back of: ";

}  // namespace fleetproof
