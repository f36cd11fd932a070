#pragma once

#include "campaign/plan/plan.hpp"
#include "reports/sections/lenient_conditions.hpp"
#include "reports/sections/report_input.hpp"

namespace fleetproof::cli {

// What a plan makes easier than one that leaves it out (core/scenario/lenient.hpp): heaviest first. Values within a
// quarter of their bound come last; of the others, those with more weight first, and of one weight the farther ones.
std::vector<LenientCondition> waived_conditions(const CampaignPlan& plan);

// Adds those of the plan in the results file.
void add_waived(ReportInput& input);

}  // namespace fleetproof::cli
