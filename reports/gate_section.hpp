#pragma once

#include <string>

#include "reports/page.hpp"

namespace fleetproof {

// What a gate found, as the predicate of a sentence: "broke the safety distance of 0.10 m in 0 of 32 worlds; the true
// share is at most 8.94 % (95 %)".
std::string finding_text(const ReportInput& input, std::size_t gate);

// All gates as a table. Below it, figures and reason of each, what was sampled, and the run to look at.
Section gate_section(const ReportInput& input);

}  // namespace fleetproof
