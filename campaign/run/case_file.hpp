#pragma once

#include <string>

#include "core/scenario/scenario.hpp"

namespace fleetproof {

// A scenario file as read_scenario reads it, whose `law.leave_out` names only laws that may be left out. Throws
// InputError.
Scenario read_case_file(const std::string& path);

}  // namespace fleetproof
