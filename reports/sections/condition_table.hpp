#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "reports/page/page.hpp"
#include "reports/sections/report_input.hpp"

namespace fleetproof {

// One row for each condition that `wanted` selects: counts and, in a claim, the interval and bound over the units of
// that row. If there are more than `most_rows` rows, those with the most failures are kept, and a remark counts the
// others.
Section condition_section(const ReportInput& input, std::string title,
                          const std::function<bool(const Condition&)>& wanted, std::size_t most_rows);

// Explains the columns of these tables, and what a unit is.
Section table_legend(const ReportInput& input);

// Confidence and method of the bounds of an agent: those of its first gate, or 95 % at any time.
GateRecord bound_rule(const Evidence& evidence, const std::string& agent);
// The same rule, for events per AGV-hour.
GateRecord hourly_rule(GateRecord rule);

}  // namespace fleetproof
