#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "generators/formats/vehicles.hpp"
#include "generators/text/json_value.hpp"

namespace fleetproof {

// What the load sets of a factsheet (loadSpecification) say of the vehicle with a load. The body covers every load that
// they allow. The lowest speed, acceleration and braking count, and the shortest times of transfers. `warnings`
// receives a sentence for each kind of thing that was left out or changed. Throws InputError with file, line, key,
// value, remedy. Requires: the vehicle has its size, speed and accelerations already.
void read_load_sets(const JsonReader& specification, ForeignVehicle& vehicle, std::vector<std::string>& warnings);

// A member as versions 2 and 3 of VDA 5050 call it. Throws InputError if there are both.
std::optional<JsonReader> either_spelling(const JsonReader& of, std::string_view old_key, std::string_view new_key);
// Throws InputError if the value is not an object.
void expect_an_object(const JsonReader& value);
// A number within these bounds. Throws InputError.
double number_within(const JsonReader& value, double low, double high);

}  // namespace fleetproof
