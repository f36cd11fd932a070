#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/layout.hpp"
#include "core/scenario/vehicle_type.hpp"

namespace fleetproof {

// A vehicle type as a file of another program describes it.
struct ForeignVehicle {
  VehicleType type{};
  std::string manufacturer{};            // empty: not given
  std::vector<std::string_view> keys{};  // of the fields that the file gives; the others have their defaults
  std::vector<std::string> vehicles{};   // names of the vehicles that are of this type

  void give(std::string_view key, double& field, double value) {
    field = value;
    keys.push_back(key);
  }
};

// Joins types that differ in nothing but their names. The first name stays.
std::vector<ForeignVehicle> joined(const std::vector<ForeignVehicle>& vehicles);

// What the permissions of a layout call a vehicle: its series, or "MANUFACTURER.SERIES" if they name that and not the
// series alone. If the manufacturer is not known, one type with such an end is meant; two may be others.
std::string name_as_permitted(const ForeignVehicle& vehicle, const Layout& layout);

// Questions about the units of a vehicle that is larger or faster than any that carries loads in a plant. Empty for
// others.
std::vector<std::string> vehicle_questions(const VehicleType& type);

// As [[vehicle]] tables of a campaign file, with the fields that the file gave. `source`: the name of that file.
std::string fleet_text(const std::vector<ForeignVehicle>& vehicles, std::string_view source);

}  // namespace fleetproof
