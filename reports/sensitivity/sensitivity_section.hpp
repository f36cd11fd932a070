#pragma once

#include <string>

#include "reports/page.hpp"
#include "reports/sensitivity/sensitivity_record.hpp"

namespace fleetproof {

// "detects 17 of 19 planted faults; misses ..."
std::string sensitivity_sentence(const SensitivityRecord& record);

// The planted faults as a table.
Table sensitivity_table(const SensitivityRecord& record);

// Which planted faults the worlds of this campaign detect, or how to measure it.
Section sensitivity_section(const ReportInput& input);

}  // namespace fleetproof
