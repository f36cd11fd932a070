#pragma once

#include <vector>

#include "reports/page.hpp"

namespace fleetproof {

// The worst run of a group in words, with its command.
Remark worst_of(const ReportInput& input, const FailureGroup& group);

// The failing runs, grouped by agent, end point, first cause and what came before it; runs with the same trace count
// once beside. Below the table, the worst run of each group with its replay line. At most `most_groups` groups.
Table failure_table(const std::vector<FailureGroup>& groups);
Section failure_section(const ReportInput& input, std::size_t most_groups);

}  // namespace fleetproof
