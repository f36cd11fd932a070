#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/layout.hpp"

namespace fleetproof {

inline constexpr double kDefaultCellPitch_m = 1.2;

// Reads a grid map of the Moving AI benchmarks or of the League of Robot Runners (.map). Every free cell becomes a
// station "r3c7" (row and column, counted from 0 at the top left). Bidirectional straight segments of the length
// `pitch_m` join neighbours on the four sides. Free cells: . G S E; of these, S and E are for storage. Blocked cells:
// @ O T W.
//
// `warnings` receives one sentence, with file and line, for everything that was guessed. Throws InputError with file,
// line, column, value and remedy if the map is not valid.
Layout read_grid_map(const std::string& path, std::vector<std::string>& warnings, double pitch_m = kDefaultCellPitch_m);
Layout parse_grid_map(std::string_view text, std::string_view source, std::vector<std::string>& warnings,
                      double pitch_m = kDefaultCellPitch_m);

}  // namespace fleetproof
