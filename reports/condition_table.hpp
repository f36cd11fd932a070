#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "reports/page.hpp"

namespace fleetproof {

// The conditions that `wanted` picks, one row each: counts, and in a claim the exact interval and bound over the units
// of that row. Beyond `most_rows` the rows with the highest bound are kept, and a remark counts the others.
Section condition_section(const ReportInput& input, std::string title,
                          const std::function<bool(const Condition&)>& wanted, std::size_t most_rows);

// What the columns of those tables mean, and what a unit is.
Section table_legend(const ReportInput& input);

// Confidence of the one-sided bound for an agent: that of its first gate, or 95 %.
double bound_confidence(const Evidence& evidence, const std::string& agent);

}  // namespace fleetproof
