#pragma once

#include <string>

#include "campaign/agent_programs.hpp"
#include "campaign/campaign_file.hpp"

namespace fleetproof::cli {

// Reads a campaign file, loads its plug-ins under the names that they give themselves, checks the plan, and tells warnings on stderr.
CampaignFile load_campaign(const std::string& path, AgentPrograms& programs);

}  // namespace fleetproof::cli
