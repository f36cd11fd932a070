#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "campaign/plan/campaign_file.hpp"
#include "campaign/run/agent_programs.hpp"

namespace fleetproof::cli {

// Reads a campaign file, loads its plug-ins under their own names, checks the plan, and prints warnings on stderr.
// Throws InputError, with file, line and column, for an agent that is not known or cannot be loaded.
CampaignFile load_campaign(const std::string& path, AgentPrograms& programs);

// The number that --jobs asks for; without it, one worker for each core. Throws InputError.
int worker_count(const std::optional<std::uint64_t>& jobs);

}  // namespace fleetproof::cli
