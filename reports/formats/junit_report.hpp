#pragma once

#include <string>

#include "reports/sections/report_input.hpp"

namespace fleetproof {

// JUnit XML as Jenkins and GitLab read it: one test case for each gate, and one for each finding. A gate that is
// violated or not demonstrated is a failure, and its type says what it fell short of; one that nothing put to the test,
// or that does not decide, is skipped; an engine error is an error. `time` is 0, because the archive knows simulated
// time only: that is a property. In the class name, dots and blanks of names are underscores.
std::string render_junit(const ReportInput& input);

}  // namespace fleetproof
