#pragma once

#include <string>
#include <vector>

#include "campaign/plan/plan.hpp"

namespace fleetproof {

// Draws the first worlds of a plan, up to 16 for each layout and fleet size: what is wrong with all or many of them is
// said before the first run. Throws NoRoom if a layout has no room for its fleet in the first world. Returns a sentence
// for each layout and fleet without room in others of these worlds, and for each fleet so large that it may stand
// still: more than one AGV for two stations.
std::vector<std::string> build_first_worlds(const CampaignPlan& plan);

}  // namespace fleetproof
