#pragma once

#include <string>

#include "reports/sections/report_input.hpp"

namespace fleetproof {

// One object with `schema_version`. Full digits; SI units in the names of the keys; digests as 16 hexadecimal digits.
std::string render_json(const ReportInput& input);

}  // namespace fleetproof
