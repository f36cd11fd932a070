#pragma once

#include <string>

#include "reports/report.hpp"

namespace fleetproof {

// For a terminal, 100 to 150 columns wide.
std::string render_text(const ReportInput& input);

}  // namespace fleetproof
