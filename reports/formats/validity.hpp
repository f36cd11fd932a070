#pragma once

#include <string>
#include <vector>

#include "reports/sections/report_input.hpp"

namespace fleetproof {

// A check of the tool or of the data. One that failed is something that the verdict counts. Known answer: a published
// value, computed anew; if it comes out otherwise, nothing that this program computes is evidence.
struct ValidityCheck {
  bool passed = true, is_known_answer = false;
  std::string text;
};

// Known answers of the random generator and of the estimators, computed now; runs that repeat others; audits.
std::vector<ValidityCheck> validity_checks(const ReportInput& input);
// Throws EngineError for the first known answer that came out otherwise.
void require_known_answers(const std::vector<ValidityCheck>& checks);
// The checks, the verdict and the exit code of `report`, and what the detector is certified for.
std::string validity_text(const ReportInput& input, const std::vector<ValidityCheck>& checks);

}  // namespace fleetproof
