#pragma once

#include <string>
#include <vector>

#include "campaign/plan/plan.hpp"
#include "reports/page/lenient_conditions.hpp"

namespace fleetproof::cli {

// What a plan makes easier than one that leaves it out (core/scenario/lenient.hpp): heaviest first. Values within a
// quarter of their bound come last; of the others, those with more weight first, and of one weight the farther ones.
std::vector<LenientCondition> waived_conditions(const CampaignPlan& plan);

// Those of a plan as a results file has it, or why they are not known.
LenientConditions lenient_conditions(const std::string& plan_json);

}  // namespace fleetproof::cli
