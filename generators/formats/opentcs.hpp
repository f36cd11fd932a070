#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/layout.hpp"
#include "generators/formats/read_choice.hpp"

namespace fleetproof {

// Reads an openTCS plant model (XML, model versions 0.0.2 to 7; millimetres become metres). Points become stations.
// Paths become one-way segments: straight, or Bezier curves for the connection types BEZIER and BEZIER_3. If the model
// has positions of its points in the drawing, too, settle_positions() chooses. Locked paths are left out. Two paths
// there and back on one track become one segment unless `choice` keeps them. A PARK_POSITION is for parking. A location
// makes the points that are linked to it points for storage, charging or parking: see purpose_of().
//
// `warnings` receives one sentence, with file and line, for each kind of thing that was left out, guessed or changed:
// how many there are, and the names of the first. Throws InputError with file, line, field, value and remedy if no AGV
// can drive on the model.
Layout read_opentcs(const std::string& path, std::vector<std::string>& warnings, const ReadChoice& choice = {});
Layout parse_opentcs(std::string_view text, std::string_view source, std::vector<std::string>& warnings,
                     const ReadChoice& choice = {});

}  // namespace fleetproof
