#include "campaign/cli/campaign_words.hpp"

#include <algorithm>

#include "campaign/cli/streams.hpp"
#include "campaign/plan/plan_check.hpp"

namespace fleetproof::cli {

CampaignFile load_campaign(const std::string& path, AgentPrograms& programs) {
  CampaignFile file = read_campaign_file(path);
  for (const std::string& plugin : file.plugins) {
    const std::string name = programs.know(plugin);
    std::ranges::replace(file.plan.agents, plugin, name);
  }
  check_plan(file.plan, file.places);
  for (const std::string& agent : file.plan.agents) programs.program(agent, path);
  constexpr std::size_t kTold = 3;
  for (std::size_t i = 0; i < std::min(kTold, file.warnings.size()); ++i) talk("warning: {}\n", file.warnings[i]);
  if (file.warnings.size() > kTold) talk("warning: {} more of this kind\n", file.warnings.size() - kTold);
  return file;
}

}  // namespace fleetproof::cli
