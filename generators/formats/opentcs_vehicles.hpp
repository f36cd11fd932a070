#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "generators/formats/vehicles.hpp"

namespace fleetproof {

// The vehicles of an openTCS plant model, by their bounding boxes and velocities. Vehicles that are alike are one type.
// `warnings` receives one sentence, with file and line, for each kind of thing that was left out or guessed. Throws
// InputError with file, line, field, value and remedy if the model has no vehicle or a number is none.
std::vector<ForeignVehicle> read_opentcs_vehicles(const std::string& path, std::vector<std::string>& warnings);
std::vector<ForeignVehicle> parse_opentcs_vehicles(std::string_view text, std::string_view source,
                                                   std::vector<std::string>& warnings);

}  // namespace fleetproof
