#pragma once

#include <vector>

#include "reports/page/page.hpp"
#include "reports/sections/report_input.hpp"

namespace fleetproof {

// One headline for each agent whose runs came out differently when they were simulated once more, and for each agent
// under test with audits that are due and not done.
std::vector<Headline> audit_headlines(const ReportInput& input);

// What the audits say about each agent.
Section audit_section(const ReportInput& input);

}  // namespace fleetproof
