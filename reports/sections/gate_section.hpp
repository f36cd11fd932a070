#pragma once

#include <string>

#include "reports/page/page.hpp"
#include "reports/sections/report_input.hpp"

namespace fleetproof {

// What a gate found, as the predicate of a sentence: "broke the safety distance of 0.10 m in 0 of 32 worlds; the true
// share is at most 8.94 % (95 %)".
std::string finding_text(const ReportInput& input, std::size_t gate);

// "Its most serious run is 936 (contact):". Requires: the gate has such a run.
std::string worst_run_text(const GateResult& result);

// All gates as a table. Below it, figures and reason of each, what was sampled, and the run to look at.
Section gate_section(const ReportInput& input);

}  // namespace fleetproof
