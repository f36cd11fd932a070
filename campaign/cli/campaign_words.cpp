#include "campaign/cli/campaign_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <thread>

#include "campaign/batch/campaign.hpp"
#include "campaign/batch/session_log.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/plan/campaign_agents.hpp"
#include "campaign/plan/default_gates.hpp"
#include "campaign/plan/first_worlds.hpp"
#include "campaign/plan/plan_check.hpp"
#include "campaign/run/agent_inspection.hpp"
#include "campaign/run/release.hpp"
#include "campaign/run/replay.hpp"
#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "core/scenario/field.hpp"
#include "generators/formats/vehicles.hpp"
#include "generators/map/permitted_types.hpp"
#include "generators/text/text_file.hpp"
#include "generators/worlds/world_maker.hpp"

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

// Pages would speak of software that did not run.
void require_own_name(const AgentFactor& agent, const AgentPrograms& programs, const std::string& place) {
  if (agent.name == agent.program) return;
  if (std::ranges::find(programs.all(), agent.name, &AgentProgram::name) == programs.all().end()) return;
  throw InputError(place, fmt::format("factors.agents: {} has the name of another agent, {}; give it a name of its own",
                                      in_quotes(agent.program), in_quotes(agent.name)));
}

// An object that is loaded once.
struct KnownObject {
  std::string program;
  bool global_symbols = false;
};

// The symbols that the campaign gives to the agent of this object. If its agents differ in them, the object has to say
// which agent it is, in a process of its own.
bool wants_global_symbols(const std::string& path, std::span<const AgentFactor> agents) {
  if (std::ranges::none_of(agents, &AgentFactor::global_symbols)) return false;
  if (std::ranges::all_of(agents, &AgentFactor::global_symbols)) return true;
  const auto agent = std::ranges::find(agents, inspect_agent(path, true).name, &AgentFactor::program);
  return agent != agents.end() && agent->global_symbols;
}

// Rules for types of vehicles that are not in the fleet may be meant for another fleet. They are told first.
void warn_of_foreign_types(CampaignFile& file) {
  std::vector<std::string> fleet, sentences;
  for (const auto& [type, share] : file.plan.vehicles) fleet.push_back(type.name);
  for (const auto& factor : file.plan.layouts) {
    if (factor.map == nullptr) continue;
    const auto foreign = foreign_types(factor.map->layout(), fleet);
    if (!foreign.empty())
      sentences.push_back(
          fmt::format("layout {}: {}", in_quotes(factor.name), sentence_on(foreign[0], factor.map->layout(), fleet)));
  }
  file.warnings.insert(file.warnings.begin(), sentences.begin(), sentences.end());
}

void warn_of_units(CampaignFile& file) {
  for (std::size_t i = 0; i < file.plan.vehicles.size(); ++i) {
    for (const std::string& question : vehicle_questions(file.plan.vehicles[i].type))
      file.warnings.push_back(fmt::format("{}: vehicle {}: {}", file.places.of(fmt::format("vehicle.{}", i)),
                                          in_quotes(file.plan.vehicles[i].type.name), question));
  }
}

// A layout of a file may be larger than an agent can tell others about. Families are never so large.
void require_room_for_agents(const CampaignFile& file, const AgentPrograms& programs) {
  const CampaignPlan& plan = file.plan;
  for (std::size_t i = 0; i < plan.agents.size(); ++i) {
    const std::string where = file.places.of(fmt::format("factors.agents.{}", i));
    const AgentProgram& program = programs.program(plan.agents[i].program, where + ": factors.agents");
    for (const LayoutFactor& layout : plan.layouts) {
      if (layout.map == nullptr) continue;
      require_room(program, *layout.map, std::ranges::max(plan.fleet_sizes), "layout " + in_quotes(layout.name),
                   where + ": factors.agents");
    }
  }
}

void warn_of_idle_gates(CampaignFile& file) {
  if (file.plan.kind != CampaignKind::Search || file.plan.gates.empty()) return;
  file.warnings.insert(file.warnings.begin(),
                       fmt::format("{}: kind is \"search\", which counts failures and judges no gate; set kind to "
                                   "\"claim\", or leave the gates out",
                                   file.places.of("gate")));
}

}  // namespace

void refuse_results(const std::string& path, std::string_view remedy) {
  constexpr std::string_view kFirstWords = "SQLite format 3";
  if (read_beginning(path, kFirstWords.size()) == kFirstWords)
    throw InputError(path, fmt::format("this holds the results of a campaign; {}", remedy));
}

CampaignFile load_campaign(const std::string& path, AgentPrograms& programs) {
  refuse_results(path, "name its campaign file (TOML)");
  CampaignFile file = read_campaign_file(path);
  std::vector<AgentFactor>& agents = file.plan.agents;
  const auto place_of = [&](std::size_t agent) { return file.places.of(fmt::format("factors.agents.{}", agent)); };
  programs.limit_inspections(file.plan.limits);
  std::map<std::string, KnownObject> known;  // by file: one object may stand there under several names
  for (std::size_t i = 0; i < agents.size(); ++i) {
    const std::string& path_of_object = file.agent_files[i];
    if (path_of_object.empty()) continue;
    const bool global_symbols = agents[i].global_symbols;
    KnownObject& object = known[path_of_object];
    if (object.program.empty())
      object = {know_at(place_of(i), path_of_object, global_symbols, programs), global_symbols};
    if (object.global_symbols != global_symbols) {
      throw InputError(place_of(i),
                       fmt::format("factors.agents: {} is loaded once; give all its agents the same symbols",
                                   in_quotes(path_of_object)));
    }
    agents[i].program = object.program;
    if (agents[i].name.empty()) agents[i].name = object.program;
  }
  for (std::size_t i = 0; i < agents.size(); ++i) require_own_name(agents[i], programs, place_of(i));
  check_plan(file.plan, file.places);
  warn_of_foreign_types(file);
  warn_of_idle_gates(file);
  warn_of_units(file);
  std::vector<bool> is_plugin;
  for (const std::string& path_of_object : file.agent_files) is_plugin.push_back(!path_of_object.empty());
  require_room_for_agents(file, programs);
  if (file.fresh_seed) file.plan.seed = fresh_seed(file.plan, programs);
  say_where_fleets_are(file.places, [&] { add_default_gates(file.plan, is_plugin); });
  for (const std::string& warning : file.warnings) talk("warning: {}\n", warning);
  constexpr std::size_t kTold = 3;
  for (std::size_t i = 0; i < std::min(kTold, file.notes.size()); ++i) talk("warning: {}\n", file.notes[i]);
  if (file.notes.size() > kTold)
    talk("warning: {} more; fleetproof import shows all of one layout\n", file.notes.size() - kTold);
  return file;
}

void try_first_worlds(const CampaignPlan& plan, const PlanPlaces& places) {
  say_where_fleets_are(places, [&] {
    for (const std::string& sentence : build_first_worlds(plan)) talk("warning: {}\n", sentence);
  });
}

void say_where_fleets_are(const PlanPlaces& places, const std::function<void()>& step) {
  try {
    step();
  } catch (const NoRoom& crowded) {
    throw InputError(places.of("factors.fleet_sizes"), "factors.fleet_sizes: " + crowded.sentence);
  }
}

void meet_plugins(const std::string& archive_path, const CampaignRecord& campaign, std::span<const AgentFactor> agents,
                  const std::vector<std::string>& named, AgentPrograms& programs, MeetPlugin meet) {
  for (const std::string& path : named) (programs.*meet)(path, wants_global_symbols(path, agents));
  const auto& plugins = campaign.plugin_agents;
  for (const AgentFactor& agent : agents) {
    if (std::ranges::find(plugins, agent.name) == plugins.end() || programs.is_plugin(agent.program)) continue;
    const std::string remembered = remembered_plugin(archive_path, agent.program);
    if (remembered.empty()) {
      throw InputError("--plugin",
                       fmt::format("the agent {} comes from a shared object, and no session log beside {} says where "
                                   "it is; name its file",
                                   in_quotes(agent.program), archive_path));
    }
    (programs.*meet)(remembered, agent.global_symbols);
  }
}

void tell_rebuilt_plugins(const CampaignRecord& campaign, std::span<const AgentFactor> agents,
                          const AgentPrograms& programs) {
  constexpr std::size_t kToldDigits = 12;
  std::set<std::string> told;
  for (const AgentFactor& factor : agents) {
    if (!programs.is_plugin(factor.program) || !told.insert(factor.program).second) continue;
    const AgentProgram& agent = programs.program(factor.program, "--plugin");
    std::vector<std::string> stored = stored_plugins(campaign.engine, agent.name);
    if (stored == std::vector{agent.sha256}) continue;
    for (std::string& digest : stored) digest = digest.substr(0, kToldDigits) + "...";
    talk("warning: {} is not the one of the campaign (stored {}, now {}...); what follows is about this one\n",
         agent.file, stored.empty() ? "nothing" : fmt::format("{}", fmt::join(stored, " and ")),
         agent.sha256.substr(0, kToldDigits));
  }
}

std::string meet_agent(const std::string& word, std::vector<std::string>& plugins, AgentPrograms& programs,
                       MeetPlugin meet, bool global_symbols) {
  const bool is_path = is_path_of_object(word);
  if (is_path && std::ranges::find(plugins, word) == plugins.end()) plugins.push_back(word);
  std::string name = word;
  for (const std::string& path : plugins) {
    const std::string met = (programs.*meet)(path, global_symbols);
    if (is_path && path == word) name = met;
  }
  return name;
}

int worker_count(const std::optional<std::uint64_t>& jobs) {
  const std::uint64_t workers = jobs.value_or(std::max(1U, std::thread::hardware_concurrency()));
  if (workers < 1 || workers > 1024)
    throw InputError("--jobs", fmt::format("is {}; it lies between 1 and 1024", workers));
  return static_cast<int>(workers);
}

std::optional<Keep> keep_of(const std::string& word) {
  if (word.empty()) return std::nullopt;
  if (const auto keep = value_of<Keep>(word)) return keep;
  throw InputError("--keep",
                   fmt::format("{} is not one of its words; {}", in_quotes(word), expected_word({}, kWordsOf<Keep>)));
}

}  // namespace fleetproof::cli
