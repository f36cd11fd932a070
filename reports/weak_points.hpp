#pragma once

#include <string>
#include <vector>

#include "reports/report.hpp"

namespace fleetproof {

// What the evidence does not support: required probes that were not met; cells with too few runs, without progress or
// with unknown outcomes; agents without a gate; runs that were not judged.
std::vector<std::string> weak_points(const ReportInput& input);

}  // namespace fleetproof
