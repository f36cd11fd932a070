#pragma once

#include <string>

#include "reports/report.hpp"

namespace fleetproof {

// For GITHUB_STEP_SUMMARY and the like: under 60 KB, whatever the campaign.
std::string render_markdown(const ReportInput& input);

}  // namespace fleetproof
