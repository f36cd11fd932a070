#pragma once

#include "reports/sections/report_input.hpp"

namespace fleetproof::cli {

// Inside GitHub Actions: adds the report to the summary of the step (the file that GITHUB_STEP_SUMMARY names), and says
// the verdict as an annotation. Elsewhere, nothing.
void tell_ci(const ReportInput& input);

}  // namespace fleetproof::cli
