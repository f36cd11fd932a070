#include "campaign/batch/sensitivity.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "campaign/batch/task_pool.hpp"
#include "campaign/run/agent_programs.hpp"
#include "campaign/workers/run_host.hpp"
#include "core/agents/agents.h"
#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"

namespace fleetproof {
namespace {

constexpr const char* kSoundAgent = "hull-lock";
constexpr double kConfidence = 0.95;
constexpr std::uint64_t kRunsAhead = 256;

std::vector<const fp_agent_type*> faulty_agents() {
  std::vector<const fp_agent_type*> agents;
  for (std::uint32_t i = 0; const fp_agent_type* agent = fp_faulty_agent(i); ++i) agents.push_back(agent);
  return agents;
}

bool is_sound_original(const std::string& program) {
  return std::ranges::any_of(faulty_agents(),
                             [&](const fp_agent_type* faulty) { return program == fp_sound_agent(faulty)->name; });
}

// What the faulty agents are compared with, each with those that are copies of a program of it: hull-lock with the
// parameters that the plan has for it, and the plan's first fleet software with computers of which each program has
// faulty copies. A plan with neither tries hull-lock.
std::vector<AgentFactor> sound_agents(const CampaignPlan& plan) {
  const auto is_central = [](const AgentFactor& agent) {
    return !agent.computers.empty() &&
           std::ranges::all_of(agent.parts(), [](const ProgramPart* part) { return is_sound_original(part->program); });
  };
  const auto is_on_board = [](const AgentFactor& agent) { return agent.program == kSoundAgent; };
  std::vector<AgentFactor> found;
  for (const auto& agent :
       {std::ranges::find_if(plan.agents, is_on_board), std::ranges::find_if(plan.agents, is_central)}) {
    if (agent == plan.agents.end()) continue;
    found.push_back(*agent);
    found.back().role = AgentRole::ByOrigin;
    found.back().name = name_of_parts(found.back());
  }
  if (found.empty()) found.emplace_back(kSoundAgent);
  return found;
}

// The same with the faulty agent in the place of its original. None: it is a copy of nothing there.
std::optional<AgentFactor> with_fault(AgentFactor agent, const std::string& name) {
  const std::vector<const fp_agent_type*> all = faulty_agents();
  const auto faulty = std::ranges::find(all, name, &fp_agent_type::name);
  if (faulty == all.end()) return std::nullopt;
  const std::string original = fp_sound_agent(*faulty)->name;
  bool replaced = false;
  const auto replace = [&](ProgramPart& part) {
    if (part.program != original) return;
    part.program = name;
    replaced = true;
  };
  replace(agent);
  for (ComputerPart& part : agent.computers) replace(part);
  agent.name = name;
  return replaced ? std::optional(agent) : std::nullopt;
}

// The faulty agents that are copies of a program of it.
std::vector<std::string> copies_of(const AgentFactor& sound) {
  std::vector<std::string> names;
  for (const fp_agent_type* faulty : faulty_agents()) {
    if (with_fault(sound, faulty->name)) names.emplace_back(faulty->name);
  }
  return names;
}

// Of these, those that are asked for, in the order in which they are asked for; none is asked for: all.
std::vector<std::string> wanted_copies(const AgentFactor& sound, const std::vector<std::string>& wanted) {
  std::vector<std::string> copies = copies_of(sound);
  if (wanted.empty()) return copies;
  std::vector<std::string> found = wanted;
  std::erase_if(found, [&](const std::string& name) { return std::ranges::find(copies, name) == copies.end(); });
  return found;
}

void require_known(const std::vector<std::string>& wanted, const std::vector<std::string>& known,
                   const std::vector<AgentFactor>& sound_ones) {
  for (const std::string& agent : wanted) {
    if (std::ranges::find(known, agent) != known.end()) continue;
    std::vector<std::string> names;
    for (const AgentFactor& sound : sound_ones) names.push_back(sound.name);
    throw InputError("--agent", fmt::format("{} is not an agent with a planted fault of {}: fleetproof list agents",
                                            in_quotes(agent), fmt::join(names, " or ")));
  }
}

// A sound agent, and what is compared with it.
struct FaultyCopies {
  AgentFactor sound;
  std::vector<AgentFactor> copies;
};

std::vector<FaultyCopies> planted_ones(const CampaignPlan& plan, const SensitivityOptions& options) {
  const std::vector<AgentFactor> sound_ones = sound_agents(plan);
  require_known(options.agents, faulty_agent_names(plan), sound_ones);
  std::vector<FaultyCopies> found;
  for (const AgentFactor& sound : sound_ones) {
    FaultyCopies tried{sound, {}};
    for (const std::string& name : wanted_copies(sound, options.agents))
      tried.copies.push_back(with_fault(sound, name).value());
    if (!tried.copies.empty()) found.push_back(std::move(tried));
  }
  return found;
}

// The agent with the fault around this program of it. Only an AGV has a position. None: there is nothing to disturb.
std::optional<AgentFactor> with_fault_around(AgentFactor agent, const std::string& program,
                                             const wrapped::Fault& fault) {
  if (fault.kind == wrapped::FaultKind::OldPosition && agent.program != program) return std::nullopt;
  const std::string with = std::string(wrapped::kWith) + text_of(fault);
  agent.name = (agent.computers.empty() ? agent.name : program) + with;
  if (agent.program == program) agent.program += with;
  for (ComputerPart& part : agent.computers) {
    if (part.program == program) part.program += with;
  }
  return agent;
}

FaultyCopies around_all_parts(AgentFactor agent, const std::vector<wrapped::Fault>& faults) {
  agent.role = AgentRole::ByOrigin;
  std::vector<std::string> programs;
  FaultyCopies tried{agent, {}};
  for (const ProgramPart* part : agent.parts()) {
    if (std::ranges::find(programs, part->program) != programs.end()) continue;
    programs.push_back(part->program);
    for (const wrapped::Fault& fault : faults) {
      if (auto copy = with_fault_around(agent, part->program, fault)) tried.copies.push_back(std::move(*copy));
    }
  }
  return tried;
}

std::vector<FaultyCopies> comparisons_of(const CampaignPlan& plan, const AgentPrograms& programs,
                                         const SensitivityOptions& options) {
  std::vector<FaultyCopies> found;
  if (!options.agents.empty() || options.with.empty()) found = planted_ones(plan, options);
  if (!options.agents.empty() && options.with.empty()) return found;
  const std::vector<wrapped::Fault> faults = options.with.empty() ? wrapped::usual_faults() : options.with;
  const bool any_foreign =
      std::ranges::any_of(plan.agents, [&](const AgentFactor& agent) { return programs.needs_worker(agent); });
  for (const AgentFactor& agent : plan.agents) {
    if (programs.needs_worker(agent) || (!any_foreign && !options.with.empty()))
      found.push_back(around_all_parts(agent, faults));
  }
  return found;
}

// The worlds of the plan, with this agent alone in them.
CampaignPlan with_agent(CampaignPlan plan, const AgentFactor& agent) {
  plan.agents = {agent};
  plan.gates.clear();
  return plan;
}

bool is_over(const SensitivityOptions& options) { return options.limit != nullptr && options.limit->is_over(); }

// Runs are handed out in order. So when a run has ended the campaign and those under way have finished, no earlier run
// is missing.
AgentTally tally_of(const CampaignPlan& plan, const AgentPrograms& programs, const SensitivityOptions& options,
                    bool until_violation) {
  AgentTally tally;
  tally.agent = plan.agents.front().name;
  const std::vector<CellRecord> cells = plan.cells();
  RunHost host(plan, programs, {.workers = options.workers});
  TaskPool<RunRecord> pool(
      {.workers = options.workers, .end = std::min(options.runs, plan.run_count()), .window = kRunsAhead},
      [&](std::uint64_t index) { return host(index); });
  pool.take_all(
      [&](std::uint64_t, const RunRecord& record) {
        if (until_violation && record.outcome.violation) pool.stop();
        tally.count(record, cells);
      },
      [&] {
        if (!is_over(options)) return;
        host.abandon();
        pool.stop();
      });
  return tally;
}

// The probe of the world that is met least often, as counted in these runs of the sound agent.
std::string rarest_probe(const RunRecord& record, const std::map<std::string, std::uint64_t>& met) {
  std::string rarest;
  std::uint64_t least = ~std::uint64_t{0};
  for (const ProbeCount& probe : record.outcome.probes) {
    const auto known = met.find(probe.name);
    const std::uint64_t runs = known == met.end() ? 0 : known->second;
    if (probe.source != ProbeSource::World || runs >= least) continue;
    rarest = probe.name;
    least = runs;
  }
  return rarest;
}

// The finding of the accused runs in which the fault shows.
void tell_first_run(FaultDetection& finding, const AccusedRuns& shows, const AgentTally& sound,
                    const std::vector<CellRecord>& cells) {
  const RunRecord& first = shows.first.at(finding.seen_as);
  if (!finding.by_rate) finding.runs = first.run_index + 1;
  finding.cell = cells[first.cell];
  finding.probe = rarest_probe(first, sound.met);
  if (!finding.by_rate && first.outcome.contact) finding.seen_as = name_of(OutcomeClass::Contact);
}

FaultDetection finding_of(AgentTally tally, const AgentTally& sound, const CampaignPlan& plan) {
  FaultDetection finding;
  finding.sound = sound.agent;
  finding.runs = tally.all.runs;
  finding.tried = !std::ranges::includes(sound.traces, tally.traces);
  if (tally.all.with(kAccusedOfViolation) > 0 && sound.all.with(kAccusedOfViolation) == 0) {
    finding.seen_as = kAccusedOfViolation;
    tell_first_run(finding, tally.all, sound, plan.cells());
  } else if (const auto accusation = more_often(tally, sound, kConfidence)) {
    finding.seen_as = accusation->name;
    finding.by_rate = true;
    finding.radio = accusation->radio;
    tell_first_run(finding, finding.radio ? tally.by_radio.at(*finding.radio) : tally.all, sound, plan.cells());
  }
  finding.tally = std::move(tally);
  return finding;
}

}  // namespace

std::uint64_t Sensitivity::detected() const {
  return static_cast<std::uint64_t>(
      std::ranges::count_if(faults, [](const FaultDetection& finding) { return !finding.seen_as.empty(); }));
}

std::vector<std::string> faulty_agent_names(const CampaignPlan& plan) {
  std::vector<std::string> names;
  for (const AgentFactor& sound : sound_agents(plan)) std::ranges::move(copies_of(sound), std::back_inserter(names));
  return names;
}

Sensitivity measure_sensitivity(const CampaignPlan& plan, const AgentPrograms& programs,
                                const SensitivityOptions& options,
                                const std::function<void(const FaultDetection&)>& told) {
  Sensitivity result;
  for (const FaultyCopies& tried : comparisons_of(plan, programs, options)) {
    const AgentTally& sound =
        result.sound.emplace_back(tally_of(with_agent(plan, tried.sound), programs, options, false));
    const bool until_violation = sound.all.with(kAccusedOfViolation) == 0;
    for (const AgentFactor& copy : tried.copies) {
      const CampaignPlan worlds = with_agent(plan, copy);
      AgentTally faulty = tally_of(worlds, programs, options, until_violation);
      if (is_over(options)) return result;  // not all of its runs are there
      result.faults.push_back(finding_of(std::move(faulty), sound, worlds));
      if (told) told(result.faults.back());
    }
  }
  return result;
}

}  // namespace fleetproof
