#pragma once

#include <string>

#include "reports/report.hpp"

namespace fleetproof {

// For the summary page of a CI system (for example GITHUB_STEP_SUMMARY): under 60 KB for every campaign.
std::string render_markdown(const ReportInput& input);

}  // namespace fleetproof
