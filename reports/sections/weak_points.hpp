#pragma once

#include <string>
#include <vector>

#include "reports/sections/report_input.hpp"

namespace fleetproof {

// What the evidence does not support. Examples: a required probe that was not met; a cell with too few runs, without
// progress or with unknown outcomes; an agent without a gate; runs that were not judged.
std::vector<std::string> weak_points(const ReportInput& input);

}  // namespace fleetproof
