#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/layout.hpp"

namespace fleetproof {

// Two paths there and back on one track stay two segments, or become one bidirectional segment (merge_antiparallel).
enum class TwinPaths : std::uint8_t { Keep, Merge };

// Reads an openTCS plant model (XML, model versions up to 7; millimetres become metres). Points become stations. Paths
// become one-way segments: straight, or Bezier curves for the connection types BEZIER and BEZIER_3. Locked paths are
// left out. A PARK_POSITION is for parking. A location that is linked to a point can make it a point for charging or
// storage. The words in the name of the location type decide.
//
// `warnings` receives one sentence, with file and line, for everything that was left out, guessed or changed. An
// example is a path with a stored length that is wrong by more than 2 %. Throws InputError with file, line, field,
// value and remedy if no AGV can drive on the model.
Layout read_opentcs(const std::string& path, std::vector<std::string>& warnings, TwinPaths twins = TwinPaths::Keep);
Layout parse_opentcs(std::string_view text, std::string_view source, std::vector<std::string>& warnings,
                     TwinPaths twins = TwinPaths::Keep);

}  // namespace fleetproof
