#pragma once

#include <string>

#include "campaign/plan/campaign_file.hpp"
#include "campaign/run/agent_programs.hpp"

namespace fleetproof::cli {

// Reads a campaign file, loads its plug-ins under the names that they give themselves, checks the plan, and tells
// warnings on stderr.
CampaignFile load_campaign(const std::string& path, AgentPrograms& programs);

}  // namespace fleetproof::cli
