#pragma once

#include "reports/page.hpp"

namespace fleetproof {

// What changed since the baseline, by agent and end point; the runs that newly fail, each with its replay line.
// Requires: the report has a baseline.
Section comparison_section(const ReportInput& input);

}  // namespace fleetproof
