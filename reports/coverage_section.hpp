#pragma once

#include <string>
#include <vector>

#include "reports/page.hpp"

namespace fleetproof {

// "never met: head-on, crossing; too rare: negotiation (1 of 40 000 runs)", or nothing.
std::string missing_text(const std::vector<MissingProbe>& missing);

// A headline for every agent whose runs did not meet what the campaign asks for.
std::vector<Headline> weak_headlines(const ReportInput& input);
// Whether one of them, or of the gates, is weak.
bool is_weak(const ReportInput& input);

// What the runs of each agent met.
Section coverage_section(const ReportInput& input, std::size_t most_rows);
// What the laws found besides pairs that were too close.
Section incident_section(const ReportInput& input, std::size_t most_rows);

}  // namespace fleetproof
