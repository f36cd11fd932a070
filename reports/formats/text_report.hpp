#pragma once

#include <string>

#include "reports/sections/report_input.hpp"

namespace fleetproof {

// For a terminal, 100 to 150 columns wide.
std::string render_text(const ReportInput& input);
// Only the top of the page: warnings, verdicts, and the table of gates.
std::string render_summary(const ReportInput& input);

}  // namespace fleetproof
