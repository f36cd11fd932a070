#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/layout.hpp"

namespace fleetproof {

// Paths back and forth on one track stay two segments, or become one bidirectional one (merge_antiparallel).
enum class TwinPaths : std::uint8_t { Keep, Merge };

// Reads an openTCS plant model (XML, model versions up to 7; millimetres become metres). Points become stations, paths
// one-way segments: straight, or Bezier curves for connection types BEZIER and BEZIER_3. A locked path is left out. A
// point is for parking if it is a PARK_POSITION, and for what the locations linked to it are for: charging or storage,
// judged by the words in the name of their type.
//
// `warnings` receives one sentence, with file and line, for all that was left out, guessed or changed; among them every
// path whose stored length is off by more than 2 %. InputError with file, line, field, value and remedy where the model
// cannot be driven on.
Layout read_opentcs(const std::string& path, std::vector<std::string>& warnings, TwinPaths twins = TwinPaths::Keep);
Layout parse_opentcs(std::string_view text, std::string_view source, std::vector<std::string>& warnings,
                     TwinPaths twins = TwinPaths::Keep);

}  // namespace fleetproof
