#pragma once

#include <string>

#include "reports/sections/report_input.hpp"

namespace fleetproof {

// A text of checks with their results: known answers of the random generator, and of the estimators against published
// values, computed now; runs that repeat others; audits; and what the detector is certified for.
std::string validity_text(const ReportInput& input);

}  // namespace fleetproof
