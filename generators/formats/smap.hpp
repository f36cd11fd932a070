#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/layout.hpp"
#include "generators/formats/read_choice.hpp"

namespace fleetproof {

// Reads a map of SEER robots (.smap): JSON of a protocol buffer, in which numbers that are 0 are left out. Points
// become stations, curves become one-way segments, as the programs of SEER draw them: straight, cubic Bezier curves,
// Bezier curves of degree 5 with doubled control points, arcs through one, rational curves. Action points, transfer
// locations and the points of bins are for storage, charge points for charging, park points for parking; words of the
// user for a class, name or label come first. `dir` is the heading of an AGV that does something at a point.
//
// `warnings` receives one sentence, with file and line, for everything that was left out, guessed or changed. Throws
// InputError with file, line, field, value and remedy if no AGV can drive on the map.
Layout read_smap(const std::string& path, std::vector<std::string>& warnings, const ReadChoice& choice = {});
Layout parse_smap(std::string_view text, std::string_view source, std::vector<std::string>& warnings,
                  const ReadChoice& choice = {});

}  // namespace fleetproof
