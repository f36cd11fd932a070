#pragma once

#include <string>
#include <vector>

#include "campaign/plan/plan.hpp"
#include "campaign/run/agent_programs.hpp"
#include "storage/records.hpp"

namespace fleetproof {

// The plan as results files store it, with the identity of this program and of the plug-ins. Each gate has its table of
// stopping decisions, and says whether it decides the verdict.
StoredPlan stored_plan(const CampaignPlan& plan, const AgentPrograms& programs);

// The first part of it.
CampaignRecord campaign_record(const CampaignPlan& plan, const AgentPrograms& programs);

// The agents of the plan that come from shared objects.
std::vector<std::string> plugin_agents(const CampaignPlan& plan, const AgentPrograms& programs);

}  // namespace fleetproof
