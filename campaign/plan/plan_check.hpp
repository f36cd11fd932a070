#pragma once

#include <string>

#include "campaign/plan/plan.hpp"
#include "campaign/plan/plan_places.hpp"

namespace fleetproof {

// Throws InputError, with the place of the key, if no run can carry out the plan: a loss of 1.4, no agents, a gate on
// an unknown agent.
void check_plan(const CampaignPlan& plan, const PlanPlaces& places);
inline void check_plan(const CampaignPlan& plan, const std::string& where) { check_plan(plan, PlanPlaces{where}); }

}  // namespace fleetproof
