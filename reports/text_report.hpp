#pragma once

#include <string>

#include "reports/report.hpp"

namespace fleetproof {

// For a terminal, 100 to 150 columns wide.
std::string render_text(const ReportInput& input);
// Its top alone: the warnings and verdicts.
std::string render_summary(const ReportInput& input);

}  // namespace fleetproof
