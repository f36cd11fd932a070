#pragma once

#include <optional>
#include <string>

namespace fleetproof {

// The minimal safety distance that the laws of a stored plan judged by. None if the plan does not say.
std::optional<double> safety_distance_m(const std::string& plan_json);

}  // namespace fleetproof
