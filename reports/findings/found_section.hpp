#pragma once

#include "reports/page.hpp"
#include "reports/report.hpp"

namespace fleetproof {

// The findings of the campaign, or how to find them.
Section findings_section(const ReportInput& input);

// "7 findings, 2 of which need attention"
std::string findings_sentence(const FoundRecord& record);

}  // namespace fleetproof
