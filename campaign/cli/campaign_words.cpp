#include "campaign/cli/campaign_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <thread>

#include "campaign/cli/streams.hpp"
#include "campaign/plan/plan_check.hpp"
#include "core/base/error.hpp"

namespace fleetproof::cli {
namespace {

// What is wrong with a shared object, at the place that names the object.
std::string know_at(const std::string& place, const std::string& path, bool global_symbols, AgentPrograms& programs) {
  try {
    return programs.know(path, global_symbols);
  } catch (const InputError& refused) {
    throw InputError(place, fmt::format("factors.agents: {}", refused.what()));
  }
}

}  // namespace

CampaignFile load_campaign(const std::string& path, AgentPrograms& programs) {
  CampaignFile file = read_campaign_file(path);
  std::vector<AgentFactor>& agents = file.plan.agents;
  const auto place_of = [&](std::size_t agent) { return file.places.of(fmt::format("factors.agents.{}", agent)); };
  std::map<std::string, std::string> known;  // program by file: one object may stand there under several names
  for (std::size_t i = 0; i < agents.size(); ++i) {
    const std::string& path_of_object = file.agent_files[i];
    if (path_of_object.empty()) continue;
    auto& program = known[path_of_object];
    if (program.empty()) program = know_at(place_of(i), path_of_object, agents[i].global_symbols, programs);
    agents[i].program = program;
    if (agents[i].name.empty()) agents[i].name = program;
  }
  check_plan(file.plan, file.places);
  for (std::size_t i = 0; i < agents.size(); ++i) programs.program(agents[i].program, place_of(i) + ": factors.agents");
  constexpr std::size_t kTold = 3;
  for (std::size_t i = 0; i < std::min(kTold, file.warnings.size()); ++i) talk("warning: {}\n", file.warnings[i]);
  if (file.warnings.size() > kTold) talk("warning: {} more of this kind\n", file.warnings.size() - kTold);
  return file;
}

int worker_count(const std::optional<std::uint64_t>& jobs) {
  const std::uint64_t workers = jobs.value_or(std::max(1U, std::thread::hardware_concurrency()));
  if (workers < 1 || workers > 1024)
    throw InputError("--jobs", fmt::format("is {}; it lies between 1 and 1024", workers));
  return static_cast<int>(workers);
}

}  // namespace fleetproof::cli
