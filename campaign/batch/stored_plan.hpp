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

// The agents of the plan that are not built in, or not with all their parts.
std::vector<std::string> plugin_agents(const CampaignPlan& plan, const AgentPrograms& programs);
// Those that have a shared object among their parts: it runs in a process of this program, so a debugger can follow it.
std::vector<std::string> object_agents(const CampaignPlan& plan, const AgentPrograms& programs);

}  // namespace fleetproof
