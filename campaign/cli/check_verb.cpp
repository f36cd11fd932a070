#include <algorithm>
#include <chrono>
#include <memory>

#include "campaign/batch/campaign.hpp"
#include "campaign/batch/pilot.hpp"
#include "campaign/batch/time_budget.hpp"
#include "campaign/cli/campaign_words.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/cli/verbs.hpp"
#include "campaign/plan/first_worlds.hpp"
#include "campaign/plan/scenario_source.hpp"
#include "campaign/run/agent_programs.hpp"
#include "campaign/run/case_file.hpp"
#include "core/base/outside_text.hpp"
#include "core/sdk/agent_table.hpp"
#include "generators/formats/importer.hpp"
#include "generators/formats/vehicles.hpp"
#include "generators/map/permitted_types.hpp"
#include "generators/scenario_file/unmet_requests.hpp"
#include "generators/scenario_file/validator.hpp"
#include "generators/worlds/world_maker.hpp"
#include "reports/page/wording.hpp"

namespace fleetproof::cli {
namespace {

constexpr std::uint64_t kReplicatesDrawn = 20;

// Enough for an estimate; `plan` measures for longer.
constexpr std::chrono::seconds kPilotTime{1};

// Draws the worlds of the first replicates, fewer of large floors, one for each layout and fleet size, and prints how
// many draws were refused and why.
void tell_rejections(const CampaignPlan& plan) {
  const ScenarioSource source(plan);
  const std::uint64_t replicates = std::min(plan.replicates, kReplicatesDrawn);
  RejectionCounts counts;
  bool fewer = false;
  const auto draw = [&](std::uint64_t run_index) -> std::size_t {
    try {
      return source.world(run_index, counts).map->station_count();
    } catch (const NoRoom&) {
      return 0;  // try_first_worlds() has said it
    }
  };
  for (std::uint64_t cell = 0; cell < plan.cell_count(); cell += plan.cells_per_world()) {
    const std::uint64_t wanted = worlds_to_draw(replicates, draw(cell));
    fewer |= wanted < replicates;
    for (std::uint64_t replicate = 1; replicate < wanted; ++replicate) draw(replicate * plan.cell_count() + cell);
  }
  const auto text = rejection_text(counts);
  put("worlds of the first {} replicates{}: {} drawn, {} more refused{}{}", replicates,
      fewer ? " (fewer on large floors)" : "", counts.worlds, counts.worlds_rejected,
      text.empty() ? "" : "; refused in them and in their starts: ", text);
  if (counts.pairs_wanted > 0) put("; {} of {} pairs made to meet", counts.pairs_made, counts.pairs_wanted);
  put("\n");
  if (counts.worlds_without_storage > 0)
    put("in {} of these worlds, orders lead between stations that are not for storage: AGVs cannot pick at one storage "
        "station and drop at another\n",
        counts.worlds_without_storage);
}

// Of programs that are in this process; the others are asked when a fault strikes.
bool is_unknown_fault(const AgentProgram& program, const std::string& word) {
  return program.opened.type != nullptr && !knows_fault(*program.opened.type, word.c_str());
}

std::string sentence_on_fault(const AgentProgram& program, const std::string& word) {
  return fmt::format("the agent {} does not know the fault {}, so it never strikes; name another one",
                     in_quotes(program.name), in_quotes(word));
}

void warn_of_unknown_faults(const CampaignPlan& plan, const AgentPrograms& programs, const std::string& path) {
  for (const auto& [computer, faults] : plan.computers) {
    for (const AgentFactor& agent : plan.agents) {
      const ComputerPart* part = agent.part_on(computer.name);
      if (part == nullptr) continue;
      const AgentProgram& program = programs.program(part->program, path);
      for (const NamedFaultRate& named : faults.named) {
        if (is_unknown_fault(program, named.word))
          talk("warning: {}: {}: {}\n", path, in_quotes(computer.name), sentence_on_fault(program, named.word));
      }
    }
  }
}

void warn_of_unknown_faults(const Scenario& scenario, const std::string& path) {
  const AgentPrograms programs;
  for (std::size_t i = 0; i < scenario.faults.size(); ++i) {
    const Fault& fault = scenario.faults[i];
    if (fault.kind != Fault::Kind::Named) continue;
    const std::string& agent = scenario.is_agv(fault.agv) ? scenario.agent : scenario.computer(fault.agv).agent;
    const AgentProgram* program = programs.known(agent);
    if (program != nullptr && is_unknown_fault(*program, fault.word))
      talk("warning: {}: /faults/{}/word: {}\n", path, i, sentence_on_fault(*program, fault.word));
  }
}

// The file is right all the same, so this is no error.
void warn_of_failures(const Pilot& pilot, const CampaignPlan& plan, const std::string& path) {
  const std::vector<CellRecord> cells = plan.cells();
  for (const AgentFactor& agent : plan.agents) {
    const auto is_of_agent = [&](const PilotFailure& failure) { return cells[failure.cell].agent == agent.name; };
    const auto first = std::ranges::find_if(pilot.failures, is_of_agent);
    if (first == pilot.failures.end()) continue;
    std::uint64_t runs = 0;
    for (std::size_t cell = 0; cell < cells.size(); ++cell)
      runs += cells[cell].agent == agent.name ? pilot.cells[cell].runs : 0;
    talk("warning: {}: {} crashed or hung in {} of {}: {}\n", path, in_quotes(agent.name),
         std::ranges::count_if(pilot.failures, is_of_agent), count_text(runs, "trial run"), printable(first->message));
  }
}

void check_campaign(const std::string& path) {
  AgentPrograms programs;
  const CampaignFile file = load_campaign(path, programs);
  const CampaignPlan& plan = file.plan;
  warn_of_unknown_faults(plan, programs, path);
  try_first_worlds(plan, file.places);
  const Pilot pilot = run_pilot(plan, programs, 1, {.time = kPilotTime, .runs = plan.cell_count()});
  warn_of_failures(pilot, plan, path);
  put("{}: ok, {} cells x {} replicates = {} runs of {:g} s; about {} of one core, as {} took {:.1f} s\n", path,
      plan.cell_count(), plan.replicates, plan.run_count(), plan.horizon_s,
      duration_text(pilot.forecast_s(plan.replicates)), count_text(pilot.runs, "run"), pilot.elapsed_s);
  tell_rejections(plan);
}

// Of a scenario, the validator refuses names that are slips. Others may be meant for another fleet.
void warn_of_foreign_types(const Scenario& scenario, const std::string& path) {
  std::vector<std::string> fleet;
  for (const VehicleType& type : scenario.vehicle_types) fleet.push_back(type.name);
  const Layout& layout = scenario.map->layout();
  for (const ForeignType& type : foreign_types(layout, fleet))
    talk("warning: {}: {}\n", path, sentence_on(type, layout, fleet));
}

// An agent that is not built in is not here: it says itself why it cannot start.
void require_room_for_agent(const Scenario& scenario, const std::string& path) {
  const AgentPrograms programs;
  const AgentProgram* program = programs.known(scenario.agent);
  if (program != nullptr) {
    require_room(*program, *scenario.map, scenario.agvs.size(), "the scenario", path + ": /agent");
    require_distribution(*program, !scenario.open_orders.empty(), !scenario.computers.empty(), path + ": /agent");
  }
  for (std::size_t i = 0; i < scenario.computers.size(); ++i) {
    const std::string &name = scenario.computers[i].name, &agent = scenario.computers[i].agent;
    const std::string where = fmt::format("{}: /computers/{}/agent", path, i);
    const AgentProgram* known = programs.known(agent);
    if (agent.empty())
      throw InputError(where, fmt::format("the computer {} has no program; name one", in_quotes(name)));
    if (known != nullptr && (known->flags & FP_SERVES_COMPUTERS) == 0)
      throw InputError(where, why_not_on_computer(agent, name));
  }
}

void check_scenario(const std::string& path) {
  const Scenario scenario = read_case_file(path);
  for (const auto& problem : problems_of(scenario))
    talk("warning: {}: {}: {}\n", path, problem.pointer, problem.sentence);
  for (const UnmetRequest& unmet : unmet_requests(scenario))
    talk("warning: {}: {}: {}\n", path, unmet.pointer, unmet.sentence);
  warn_of_foreign_types(scenario, path);
  require_room_for_agent(scenario, path);
  warn_of_unknown_faults(scenario, path);
  for (const VehicleType& type : scenario.vehicle_types) {
    for (const std::string& question : vehicle_questions(type))
      talk("warning: {}: vehicle {}: {}\n", path, in_quotes(type.name), question);
  }
  put("{}: ok, {} stations, {} segments, {} AGVs, {:g} s\n", path, scenario.map->station_count(),
      scenario.map->segment_count(), scenario.agvs.size(), to_seconds(scenario.horizon));
}

int check(const std::vector<std::string>& files) {
  for (const std::string& file : files) has_ending(file, ".json") ? check_scenario(file) : check_campaign(file);
  return kDemonstrated;
}

}  // namespace

Action prepare_check(Options& options) {
  auto files = std::make_shared<std::vector<std::string>>();
  options.positionals("FILE", *files, "campaign files (TOML) or scenario files (JSON)");
  return [files] { return check(*files); };
}

}  // namespace fleetproof::cli
