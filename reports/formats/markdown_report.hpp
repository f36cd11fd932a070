#pragma once

#include <string>

#include "reports/sections/report_input.hpp"

namespace fleetproof {

// For the summary page of a CI system (for example GITHUB_STEP_SUMMARY): long tables are cut.
std::string render_markdown(const ReportInput& input);

}  // namespace fleetproof
