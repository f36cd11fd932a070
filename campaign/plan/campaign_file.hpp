#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "campaign/plan/campaign_agents.hpp"
#include "campaign/plan/plan.hpp"
#include "campaign/plan/plan_places.hpp"

namespace fleetproof {

// A campaign file: its plan, and what does not belong into the plan.
struct CampaignFile {
  CampaignPlan plan;
  std::vector<AgentFiles> agent_files;  // by agent of the plan
  std::vector<std::string> warnings;    // what the campaign cannot do, or does otherwise than its author may expect
  std::vector<std::string> notes;       // what the readers of its layouts left out, guessed or changed
  PlanPlaces places;
  bool fresh_seed = false;  // seed = "fresh": the seed follows from release and plan (campaign/run/release.hpp)
};

// Reads a TOML campaign file. A layout that is named by its file is read relative to the campaign file. Its extension
// names its format (importers()). Throws InputError with file, line and column, the key, its value and the nearest
// valid key.
CampaignFile read_campaign_file(const std::string& path);
CampaignFile parse_campaign_file(std::string_view text, const std::string& path);

}  // namespace fleetproof
