// Vehicle types from VDA 5050 factsheets, with the loads that they carry.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "generators/formats/vehicles.hpp"

namespace fleetproof {

// The vehicle that a VDA 5050 factsheet describes (versions 2 and 3): its size, its speed and accelerations. An
// envelope says where its body is around its reference point. `warnings` receives one sentence, with file and line, for
// each kind of thing that was left out or changed. Throws InputError with file, line, key, value and remedy.
ForeignVehicle read_factsheet(const std::string& path, std::vector<std::string>& warnings);
ForeignVehicle parse_factsheet(std::string_view text, std::string_view source, std::vector<std::string>& warnings);

}  // namespace fleetproof
