#pragma once

#include "campaign/plan/plan.hpp"
#include "campaign/plan/plan_places.hpp"

namespace fleetproof {

// Throws InputError if a gate of the plan names what the plan does not have, or if no cell is left for it. Bounds of
// single fields are not checked here.
void check_gates(const CampaignPlan& plan, const PlanPlaces& places);

}  // namespace fleetproof
