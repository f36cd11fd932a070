#pragma once

#include "reports/page/page.hpp"
#include "reports/sections/report_input.hpp"

namespace fleetproof {

// How often each agent failed on each layout, and with each fleet size: worlds with a violation and their bound, events
// per AGV-hour with an interval, stalled worlds. In a search only counts.
Section layout_section(const ReportInput& input, std::size_t most_rows);
Section fleet_section(const ReportInput& input, std::size_t most_rows);

}  // namespace fleetproof
