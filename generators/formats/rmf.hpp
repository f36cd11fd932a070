#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/layout.hpp"

namespace fleetproof {

// Which part of an Open-RMF building to read.
struct RmfChoice {
  std::string level;           // empty: the first one
  std::int64_t graph_idx = 0;  // of a building file; a nav graph is one graph
};

// Reads one level of an Open-RMF building, as the traffic editor keeps it (*.building.yaml) or as a nav graph generated
// from it (0.yaml). Vertices that a lane of the graph touches become stations, lanes straight segments; lanes there and
// back become one bidirectional segment. A building drawn on an image is scaled by its measurements (mean of metres per
// pixel) and its y axis, which points down, is turned up. Chargers, parking spots, dispensers and ingestors give
// stations their purposes.
//
// `warnings` receives one sentence, with file and line, for all that was left out, guessed or changed. InputError with
// file, line, field, value and remedy where the level cannot be driven on.
Layout read_rmf(const std::string& path, std::vector<std::string>& warnings, const RmfChoice& choice = {});
Layout parse_rmf(std::string_view text, std::string_view source, std::vector<std::string>& warnings,
                 const RmfChoice& choice = {});

}  // namespace fleetproof
