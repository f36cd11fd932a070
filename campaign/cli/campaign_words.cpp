#include "campaign/cli/campaign_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <stdexcept>
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
#include "core/bridges/wrapped/fault_words.hpp"
#include "core/scenario/field.hpp"
#include "generators/formats/vehicles.hpp"
#include "generators/map/permitted_types.hpp"
#include "generators/text/text_file.hpp"
#include "generators/worlds/world_maker.hpp"
#include "storage/target_file.hpp"

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

// The file or name of a program, and the faults around it.
wrapped::WrappedWord parts_of_word(const std::string& word, const std::string& place) {
  try {
    return wrapped::split_checked(word);
  } catch (const std::invalid_argument& wrong) {
    throw InputError(place, wrong.what());
  }
}

// Pages would speak of software that did not run.
void require_own_name(const AgentFactor& agent, const AgentPrograms& programs, const std::string& place) {
  if (agent.name == name_of_parts(agent)) return;
  if (programs.known(agent.name) == nullptr) return;
  throw InputError(place, fmt::format("factors.agents: {} has the name of another agent, {}; give it a name of its own",
                                      in_quotes(name_of_parts(agent)), in_quotes(agent.name)));
}

// The shared objects that a campaign names, each of which is loaded once: it may stand there under several names.
class KnownObjects {
 public:
  explicit KnownObjects(AgentPrograms& programs) : programs_(programs) {}

  // Gives a part of an agent the name of its program. `word` is empty: it is none of a shared object.
  void name_program(ProgramPart& part, const std::string& word, const std::string& place) {
    if (word.empty()) return;
    const auto [path, with] = parts_of_word(word, place + ": factors.agents");
    Known& object = known_[canonical(path)];
    if (object.program.empty()) object = {know_at(place, path, part.global_symbols, programs_), part.global_symbols};
    if (object.global_symbols != part.global_symbols) {
      throw InputError(place, fmt::format("factors.agents: {} is loaded once; give all its agents the same symbols",
                                          in_quotes(path)));
    }
    part.program = object.program + with;
  }

 private:
  // One file may have several names. One that is not there has its own.
  static std::string canonical(const std::string& path) {
    std::error_code ignored;
    const auto whole = std::filesystem::canonical(path, ignored);
    return ignored ? path : whole.string();
  }
  struct Known {
    std::string program;
    bool global_symbols = false;
  };
  AgentPrograms& programs_;
  std::map<std::string, Known> known_;  // by file
};

// The symbols that the campaign gives to the agent of this object. If its agents differ in them, the object has to say
// which agent it is, in a process of its own.
bool wants_global_symbols(const std::string& path, std::span<const AgentFactor> agents) {
  std::vector<const ProgramPart*> parts;
  for (const AgentFactor& agent : agents) std::ranges::copy(agent.parts(), std::back_inserter(parts));
  if (std::ranges::none_of(parts, &ProgramPart::global_symbols)) return false;
  if (std::ranges::all_of(parts, &ProgramPart::global_symbols)) return true;
  const auto part = std::ranges::find(parts, inspect_agent(path, true).name,
                                      [](const ProgramPart* other) { return wrapped::bare_name(other->program); });
  return part != parts.end() && (*part)->global_symbols;
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

void require_roles(const CampaignPlan& plan, const AgentFactor& agent, const AgentPrograms& programs,
                   const std::string& where) {
  for (const ComputerPart& part : agent.computers) {
    if ((programs.program(part.program, where).flags & FP_SERVES_COMPUTERS) == 0)
      throw InputError(where, "factors.agents: " + why_not_on_computer(part.program, part.computer));
  }
  std::vector<std::string> computers;
  for (const PlannedComputer& computer : plan.computers) {
    if (agent.part_on(computer.setup.name) != nullptr) computers.push_back(computer.setup.name);
  }
  if (const std::string why_not = why_no_server(agent, computers); !why_not.empty())
    throw InputError(where, "factors.agents: " + why_not);
}

// A layout of a file may be larger than an agent can tell others about. Families are never so large.
void require_room_for_agents(const CampaignFile& file, const AgentPrograms& programs) {
  const CampaignPlan& plan = file.plan;
  for (std::size_t i = 0; i < plan.agents.size(); ++i) {
    const std::string where = file.places.of(fmt::format("factors.agents.{}", i));
    for (const AgentProgram* program : programs.parts_of(plan.agents[i], where + ": factors.agents")) {
      for (const LayoutFactor& layout : plan.layouts) {
        if (layout.map == nullptr) continue;
        require_room(*program, *layout.map, std::ranges::max(plan.fleet_sizes), "layout " + in_quotes(layout.name),
                     where + ": factors.agents");
      }
    }
    require_roles(plan, plan.agents[i], programs, where);
    require_distribution(programs.program(plan.agents[i].program, where),
                         plan.order_setup.transports == OrderKind::Open, !plan.agents[i].computers.empty(),
                         where + ": factors.agents");
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
  KnownObjects known(programs);
  for (std::size_t i = 0; i < agents.size(); ++i) {
    known.name_program(agents[i], file.agent_files[i].front(), place_of(i));
    for (std::size_t k = 0; k < agents[i].computers.size(); ++k)
      known.name_program(agents[i].computers[k], file.agent_files[i][k + 1], place_of(i));
    if (agents[i].name.empty()) agents[i].name = name_of_parts(agents[i]);
  }
  for (std::size_t i = 0; i < agents.size(); ++i) require_own_name(agents[i], programs, place_of(i));
  check_plan(file.plan, file.places);
  warn_of_foreign_types(file);
  warn_of_idle_gates(file);
  warn_of_units(file);
  std::vector<bool> is_plugin;
  for (const AgentFactor& agent : agents) is_plugin.push_back(programs.needs_worker(agent));
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
    if (std::ranges::find(plugins, agent.name) == plugins.end()) continue;
    for (const ProgramPart* part : agent.parts()) {
      if (programs.known(part->program) != nullptr) continue;
      const std::string name = wrapped::bare_name(part->program), remembered = remembered_plugin(archive_path, name);
      if (remembered.empty()) {
        throw InputError(
            "--plugin", fmt::format("the agent {} is not built in, and no session log beside {} says where it is; name "
                                    "its shared object, or \"lockstep:COMMAND\"",
                                    in_quotes(name), archive_path));
      }
      (programs.*meet)(remembered, part->global_symbols);
    }
  }
}

void tell_rebuilt_plugins(const CampaignRecord& campaign, std::span<const AgentFactor> agents,
                          const AgentPrograms& programs) {
  constexpr std::size_t kToldDigits = 12;
  std::set<std::string> told;
  for (const AgentFactor& factor : agents) {
    for (const AgentProgram* part : programs.parts_of(factor, "--plugin")) {
      if (part->is_built_in() || !told.insert(part->name).second) continue;
      std::vector<std::string> stored = stored_plugins(campaign.engine, part->innermost().name);
      if (stored == std::vector{part->source.sha256}) continue;
      for (std::string& digest : stored) digest = digest.substr(0, kToldDigits) + "...";
      talk("warning: {} is not the one of the campaign (stored {}, now {}...); what follows is about this one\n",
           part->source.file, stored.empty() ? "nothing" : fmt::format("{}", fmt::join(stored, " and ")),
           part->source.sha256.substr(0, kToldDigits));
    }
  }
}

std::string meet_agent(const std::string& word, std::vector<std::string>& plugins, AgentPrograms& programs,
                       MeetPlugin meet, bool global_symbols) {
  const auto [bare, with] = parts_of_word(word, "--agent");
  const bool is_path = is_path_of_object(bare);
  if (is_path && std::ranges::find(plugins, bare) == plugins.end()) plugins.push_back(bare);
  std::string name = bare;
  for (const std::string& path : plugins) {
    const std::string met = (programs.*meet)(path, global_symbols);
    if (is_path && path == bare) name = met;
  }
  return name + with;
}

void add_computer_option(Options& options, std::vector<std::string>& programs) {
  options.option(
      "--computer", programs,
      "program of a computer of the scenario, as server=zone-server; the name may be left out if there is one "
      "computer (default: the scenario file's); may be repeated");
}

void take_computer_programs(Scenario& scenario, const std::vector<std::string>& programs, std::string_view what) {
  std::vector<std::string_view> names;
  for (const ComputerSetup& computer : scenario.computers) names.emplace_back(computer.name);
  for (const std::string& word : programs) {
    if (names.empty())
      throw InputError("--computer",
                       fmt::format("{} has no computer, so {} serves nobody; leave it out", what, in_quotes(word)));
    const std::size_t sign = word.find('=');
    if (sign == std::string::npos && names.size() > 1)
      throw InputError("--computer", fmt::format("{} has {} computers; say which one runs {}: --computer {}={}", what,
                                                 names.size(), in_quotes(word), names[0], word));
    const std::string name = sign == std::string::npos ? std::string(names[0]) : word.substr(0, sign);
    const auto computer = std::ranges::find(scenario.computers, name, &ComputerSetup::name);
    if (computer == scenario.computers.end())
      throw InputError("--computer",
                       fmt::format("{} has no computer {}{}", what, in_quotes(name), name_hint(name, names)));
    computer->agent = sign == std::string::npos ? word : word.substr(sign + 1);
    if (computer->agent.empty())
      throw InputError("--computer", fmt::format("{} names no program; write {}=PROGRAM", in_quotes(word), name));
  }
}

std::vector<ComputerPart> computer_parts(const Scenario& scenario, std::vector<std::string>& plugins,
                                         AgentPrograms& programs, MeetPlugin meet, bool global_symbols) {
  std::vector<ComputerPart> parts;
  for (const ComputerSetup& computer : scenario.computers) {
    if (computer.agent.empty()) continue;
    ComputerPart& part = parts.emplace_back();
    part.computer = computer.name;
    part.config = computer.agent_config;
    const auto [bare, with] = parts_of_word(computer.agent, "--computer");
    part.program = bare + with;
    if (!is_path_of_object(bare)) {
      if (std::ranges::find(programs.all(), bare, &AgentProgram::name) == programs.all().end())
        throw InputError("--plugin",
                         fmt::format("the computer {} runs {}, which is not built in; name its shared object or "
                                     "\"lockstep:COMMAND\", or another program with --computer",
                                     in_quotes(computer.name), in_quotes(computer.agent)));
      continue;
    }
    const auto known = std::ranges::find(programs.all(), absolute_name(bare),
                                         [](const AgentProgram& program) { return program.source.file; });
    part.program = (known != programs.all().end() ? known->name : (programs.*meet)(bare, global_symbols)) + with;
    if (std::ranges::find(plugins, bare) == plugins.end()) plugins.push_back(bare);
  }
  return parts;
}

void add_symbols_option(Options& options, bool& global_symbols) {
  options.flag("--global-symbols", global_symbols,
               "load the shared objects with RTLD_GLOBAL, as embedded Python needs it (symbols = \"global\" of a "
               "campaign)");
}

void refuse_idle_symbols(bool global_symbols, const AgentFactor& agent, const AgentPrograms& programs) {
  if (global_symbols && !programs.needs_worker(agent))
    throw InputError("--global-symbols", fmt::format("has no meaning for {}, which comes from no shared object; name "
                                                     "one with --plugin",
                                                     in_quotes(name_of_parts(agent))));
}

std::string plugin_options(const AgentFactor& agent, const AgentPrograms& programs, const std::string& folder) {
  std::string words;
  bool global_symbols = false;
  for (const AgentProgram* program : programs.foreign_parts_of(agent)) {
    words += " --plugin " + shell_word(word_of(program->source, folder));
    global_symbols = global_symbols || program->source.global_symbols;
  }
  return words + (global_symbols ? " --global-symbols" : "");
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
