#pragma once

#include <string>
#include <vector>

#include "reports/report.hpp"

namespace fleetproof {

// What this evidence does not carry: probes that were to be met and were not, cells with too few runs, without progress
// or with unknown outcomes, agents without a gate, runs that were not judged.
std::vector<std::string> weak_points(const ReportInput& input);

}  // namespace fleetproof
