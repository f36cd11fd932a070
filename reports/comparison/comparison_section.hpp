#pragma once

#include <string>
#include <vector>

#include "reports/comparison/baseline.hpp"
#include "reports/page/page.hpp"

namespace fleetproof {

// What changed since the baseline, by agent and end point; the runs that newly fail, each with its replay line.
// Requires: there is a comparison.
Section comparison_section(const std::vector<BaselineComparison>& baseline, const std::string& archive_path);

}  // namespace fleetproof
