#pragma once

#include <string>
#include <vector>

#include "reports/page/page.hpp"
#include "reports/sections/report_input.hpp"

namespace fleetproof {

// Engine errors, and the violations of each agent under test in the contract region. They stand above all verdicts,
// even if the gates tolerate them.
std::vector<Headline> warnings(const ReportInput& input);

// The claim of the campaign in one sentence, by the gates that speak for it: a violated one if the campaign is
// violated, an open one if it is not demonstrated. Below it, the reasons, the runs to look at, and what was sampled.
std::vector<Headline> verdicts(const ReportInput& input);

// What the claim counts as unknown because of fallen loads and obstacles, by agent under test.
std::vector<Headline> foreign_body_notes(const ReportInput& input);

// "run 7: violation, 0.07 m at 12.345 s between AGV 1 and AGV 3; agent sound, layout ring, fleet of 5, loss
// 40 %, delay 2 s"
Remark describe(const ReportInput& input, const FailingRun& run);

}  // namespace fleetproof
