#include "campaign/batch/sensitivity.hpp"

#include <algorithm>
#include <chrono>

#include "campaign/batch/task_pool.hpp"
#include "campaign/run/run_one.hpp"
#include "core/agents/agents.h"
#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "reports/evidence/binomial.hpp"

namespace fleetproof {
namespace {

constexpr const char* kSoundAgent = "hull-lock";
constexpr const char* kViolation = "violation";
constexpr const char* kStuck = "stuck";
constexpr double kConfidence = 0.95;
constexpr std::uint64_t kRunsAhead = 256;

// The worlds of the plan, with this agent alone in them.
CampaignPlan with_agent(CampaignPlan plan, const std::string& agent) {
  const auto sound =
      std::ranges::find_if(plan.agents, [](const AgentFactor& known) { return known.program == kSoundAgent; });
  plan.agent_config = sound != plan.agents.end() ? plan.config_of(*sound) : std::string();
  plan.agents = {AgentFactor(agent)};
  plan.gates.clear();
  return plan;
}

// Without the links of a deadlock, which are filed beside it.
std::vector<std::string> accusations_of(const Outcome& outcome) {
  std::vector<std::string> names;
  if (outcome.violation) names.emplace_back(kViolation);
  if (outcome.stuck) names.emplace_back(kStuck);
  for (const Incident& incident : outcome.incidents) {
    if (!accuses(incident.kind) || incident.kind == IncidentKind::WaitsDeclared ||
        incident.kind == IncidentKind::WaitsInferred)
      continue;
    names.emplace_back(info_of(incident.kind).name);
  }
  std::ranges::sort(names);
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

void count(AgentTally& tally, RunRecord record) {
  ++tally.runs;
  tally.traces.emplace(record.run_index, record.outcome.digest);
  for (const ProbeCount& probe : record.outcome.probes) {
    if (probe.source == ProbeSource::World) ++tally.met[probe.name];
  }
  for (const std::string& name : accusations_of(record.outcome)) {
    ++tally.accused[name];
    const auto [known, is_new] = tally.first.try_emplace(name, record);
    if (!is_new && record.run_index < known->second.run_index) known->second = record;
  }
}

// Runs are handed out in order. So when a run has ended the campaign and those under way have finished, no earlier run
// is missing.
AgentTally tally_of(const CampaignPlan& plan, const AgentPrograms& programs, const SensitivityOptions& options,
                    bool until_violation) {
  AgentTally tally;
  tally.agent = plan.agents.front().name;
  const RunOne run_one(plan, programs);
  TaskPool pool(options.workers, 0, std::min(options.runs, plan.run_count()), kRunsAhead,
                [&](std::uint64_t index) { return std::optional(run_one(index)); });
  while (!pool.finished()) {
    std::optional<RunRecord> record = pool.next(std::chrono::milliseconds(10));
    if (!record) continue;
    if (until_violation && record->outcome.violation) pool.stop();
    count(tally, std::move(*record));
  }
  return tally;
}

std::uint64_t runs_with(const AgentTally& tally, const std::string& accusation) {
  const auto known = tally.accused.find(accusation);
  return known == tally.accused.end() ? 0 : known->second;
}

// What the fault is accused of more often than the sound agent; empty: nothing. The clearest difference counts.
std::string more_often(const AgentTally& fault, const AgentTally& sound) {
  if (fault.accused.empty()) return {};
  std::string clearest;
  double widest = 0.0;
  const Confidence each = Confidence(kConfidence).shared(2.0 * static_cast<double>(fault.accused.size()));
  for (const auto& [name, runs] : fault.accused) {
    const double gap = lower_bound(runs, fault.runs, each) - upper_bound(runs_with(sound, name), sound.runs, each);
    if (gap <= widest) continue;
    widest = gap;
    clearest = name;
  }
  return clearest;
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

FaultFinding finding_of(AgentTally tally, const AgentTally& sound, const CampaignPlan& plan) {
  FaultFinding finding;
  finding.runs = tally.runs;
  const bool violates = runs_with(tally, kViolation) > 0 && runs_with(sound, kViolation) == 0;
  finding.seen_as = violates ? kViolation : more_often(tally, sound);
  finding.by_rate = !violates && !finding.seen_as.empty();
  finding.tried = !std::ranges::includes(sound.traces, tally.traces);
  if (!finding.seen_as.empty()) {
    const RunRecord& first = tally.first.at(finding.seen_as);
    if (violates) finding.runs = first.run_index + 1;
    finding.cell = plan.cells()[first.cell];
    finding.probe = rarest_probe(first, sound.met);
    if (violates && first.outcome.contact) finding.seen_as = "contact";
  }
  finding.tally = std::move(tally);
  return finding;
}

}  // namespace

std::uint64_t Sensitivity::detected() const {
  return static_cast<std::uint64_t>(
      std::ranges::count_if(faults, [](const FaultFinding& finding) { return !finding.seen_as.empty(); }));
}

std::vector<std::string> faulty_agent_names() {
  std::vector<std::string> names;
  for (std::uint32_t i = 0; i < fp_faulty_agent_count; ++i) names.emplace_back(fp_faulty_agents[i]->name);
  return names;
}

Sensitivity measure_sensitivity(const CampaignPlan& plan, const AgentPrograms& programs,
                                const SensitivityOptions& options,
                                const std::function<void(const FaultFinding&)>& told) {
  const std::vector<std::string> faulty = faulty_agent_names();
  for (const std::string& agent : options.agents) {
    if (std::ranges::find(faulty, agent) == faulty.end())
      throw InputError("--agent", in_quotes(agent) + " is not an agent with a planted fault: fleetproof list agents");
  }
  Sensitivity result;
  result.sound = tally_of(with_agent(plan, kSoundAgent), programs, options, false);
  for (const std::string& agent : options.agents.empty() ? faulty : options.agents) {
    const CampaignPlan worlds = with_agent(plan, agent);
    const bool until_violation = runs_with(result.sound, kViolation) == 0;
    result.faults.push_back(finding_of(tally_of(worlds, programs, options, until_violation), result.sound, worlds));
    if (told) told(result.faults.back());
  }
  return result;
}

}  // namespace fleetproof
