#pragma once

#include <string>

#include "reports/report.hpp"

namespace fleetproof {

// JUnit XML as Jenkins and GitLab read it: one test case for each gate. A gate that is violated or not demonstrated is
// a failure; one that nothing put to the test, or that does not decide, is skipped; an engine error is an error. `time`
// is the simulated time of the gate's runs, per AGV, in seconds.
std::string render_junit(const ReportInput& input);

}  // namespace fleetproof
