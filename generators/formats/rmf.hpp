// Layouts of Open-RMF: reading building files.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/layout.hpp"
#include "generators/map/antiparallel.hpp"

namespace fleetproof {

// The part of an Open-RMF building to read.
struct RmfChoice {
  std::string level;           // empty: the first level that has lanes
  std::int64_t graph_idx = 0;  // of a building file; a nav graph contains one graph
  TwinPaths twins = TwinPaths::Merge;
};

// Reads one level of an Open-RMF building: the file of the traffic editor (*.building.yaml), or a nav graph that was
// generated from it (0.yaml). Vertices on a lane of the graph become stations; vertices that a lane without a length
// joins become one. Lanes become straight segments. Two lanes there and back become one bidirectional segment. A
// building that is drawn on an image is scaled by its measurements (mean of metres per pixel). Its y axis points down
// and is turned up. Chargers, parking spots, dispensers and ingestors give stations their purposes.
//
// `warnings` receives one sentence, with file and line, for everything that was left out, guessed or changed. Throws
// InputError with file, line, field, value and remedy if no AGV can drive on the level.
Layout read_rmf(const std::string& path, std::vector<std::string>& warnings, const RmfChoice& choice = {});
Layout parse_rmf(std::string_view text, std::string_view source, std::vector<std::string>& warnings,
                 const RmfChoice& choice = {});

}  // namespace fleetproof
