#pragma once

#include <string>

#include "campaign/plan/campaign_file.hpp"
#include "campaign/run/agent_programs.hpp"

namespace fleetproof::cli {

// Reads a campaign file, loads its plug-ins under their own names, checks the plan, and prints warnings on stderr.
// Throws InputError, with file, line and column, for an agent that is not known or cannot be loaded.
CampaignFile load_campaign(const std::string& path, AgentPrograms& programs);

}  // namespace fleetproof::cli
