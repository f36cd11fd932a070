#pragma once

#include <string>
#include <vector>

#include "reports/page/page.hpp"
#include "reports/sections/report_input.hpp"

namespace fleetproof {

// "never met: head-on, crossing; too rare: negotiation (1 of 40 000 runs)", or nothing.
std::string missing_text(const std::vector<MissingProbe>& missing);

// One headline for each agent under test whose runs did not meet what the campaign asks for.
std::vector<Headline> weak_headlines(const ReportInput& input);
// Whether the evidence of an agent under test, or of one of its gates, is weak.
bool is_weak(const ReportInput& input);

// What the runs of each agent met.
Section coverage_section(const ReportInput& input, std::size_t most_rows);
// The incidents: what the laws found besides violations.
Section incident_section(const ReportInput& input, std::size_t most_rows);

}  // namespace fleetproof
