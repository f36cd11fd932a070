#pragma once

#include <string>

#include "reports/page/page.hpp"
#include "reports/sensitivity/sensitivity_record.hpp"

namespace fleetproof {

// "detects 17 of 19 planted faults; misses ..."
std::string sensitivity_sentence(const SensitivityRecord& record);

// The planted faults as a table.
Table sensitivity_table(const SensitivityRecord& record);

// Which planted faults the worlds of a campaign detect, or how to measure it. `program_sha256`: of its program.
Section sensitivity_section(const SensitivityFile& file, const std::string& archive_path,
                            const std::string& program_sha256);

}  // namespace fleetproof
