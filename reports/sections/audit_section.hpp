#pragma once

#include <vector>

#include "reports/page/page.hpp"
#include "reports/sections/report_input.hpp"

namespace fleetproof {

// One headline for each agent whose runs came out differently when they were simulated once more, and for each agent
// under test with audits that are due and not done.
std::vector<Headline> audit_headlines(const ReportInput& input);

// Whether the runs of the agent that came out differently do so because of earlier runs of the same process: a session
// that looked closer says it. The log of another results file says nothing about this one.
bool depends_on_earlier_runs(const ReportInput& input, const AgentAudit& audit);

// What the audits say about each agent.
Section audit_section(const ReportInput& input);

}  // namespace fleetproof
