#pragma once

#include <string_view>
#include <vector>

#include "reports/page/page.hpp"
#include "reports/sections/report_input.hpp"

namespace fleetproof {

inline constexpr const char* kFailuresTitle = "Runs in which something went wrong, by the failure that leads";
// What the columns of the table mean.
inline constexpr std::string_view kFailureColumns =
    "Runs with an unknown outcome stand here, too. End point = the most serious thing that happened in the run; at "
    "hazardous speed = above 0.3 m/s. Leading = the heaviest failure that the software answers for; the rest may be "
    "its consequence. Before it = "
    "what the scenario had done to the bodies involved; that is an order in time and shows no cause. Distinct = the "
    "number of different traces.";

// The worst run of a group in words, with its command.
Remark worst_of(const ReportInput& input, const FailureGroup& group);

// The failing runs, grouped by agent, end point, leading failure and what came before it; runs with the same trace
// count once beside. Below the table, the worst run of each group with its replay line. At most `most_groups` groups.
Table failure_table(const std::vector<FailureGroup>& groups);
Section failure_section(const ReportInput& input, std::size_t most_groups);

}  // namespace fleetproof
