#include "campaign/batch/agent_tally.hpp"

#include <algorithm>

#include "reports/evidence/binomial.hpp"

namespace fleetproof {
namespace {

// Without the links of a deadlock, which are filed beside it.
std::vector<std::string> accusations_of(const Outcome& outcome) {
  std::vector<std::string> names;
  if (outcome.violation) names.emplace_back(kAccusedOfViolation);
  if (outcome.stuck) names.emplace_back(name_of(OutcomeClass::Stuck));
  for (const Incident& incident : outcome.incidents) {
    const IncidentKindInfo& info = info_of(incident.kind);
    if (info.role == IncidentRole::Accusation) names.emplace_back(info.name);
  }
  std::ranges::sort(names);
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

// By how much the rate is surely higher; negative: not surely.
double sure_gap(const std::string& name, const AccusedRuns& agent, const AccusedRuns& sound, const Confidence& each) {
  return lower_bound(agent.with(name), agent.runs, each) - upper_bound(sound.with(name), sound.runs, each);
}

}  // namespace

void AccusedRuns::count(const RunRecord& record) {
  ++runs;
  for (const std::string& name : accusations_of(record.outcome)) {
    ++accused[name];
    const auto [known, is_new] = first.try_emplace(name, record);
    if (!is_new && record.run_index < known->second.run_index) known->second = record;
  }
}

std::uint64_t AccusedRuns::with(const std::string& accusation) const {
  const auto known = accused.find(accusation);
  return known == accused.end() ? 0 : known->second;
}

void AgentTally::count(const RunRecord& record, const std::vector<CellRecord>& cells) {
  all.count(record);
  by_radio[{cells[record.cell].lowest, cells[record.cell].highest}].count(record);
  traces.emplace(record.run_index, record.outcome.digest);
  for (const ProbeCount& probe : record.outcome.probes) {
    if (probe.source == ProbeSource::World) ++met[probe.name];
  }
}

std::optional<Accusation> more_often(const AgentTally& agent, const AgentTally& sound, double confidence) {
  if (agent.all.accused.empty()) return std::nullopt;
  const std::size_t radios = agent.by_radio.size() > 1 ? agent.by_radio.size() : 0;
  const auto comparisons = static_cast<double>(agent.all.accused.size() * (1 + radios));
  const Confidence each = Confidence(confidence).shared(2.0 * comparisons);
  std::optional<Accusation> clearest;
  double widest = 0.0;
  const auto compare = [&](const std::string& name, const AccusedRuns& its, const AccusedRuns& others,
                           const std::optional<RadioCondition>& radio) {
    const double gap = sure_gap(name, its, others, each);
    if (gap <= widest) return;
    widest = gap;
    clearest = {name, radio};
  };
  for (const auto& [name, runs] : agent.all.accused) {
    compare(name, agent.all, sound.all, std::nullopt);
    if (radios == 0) continue;
    for (const auto& [radio, its] : agent.by_radio) compare(name, its, sound.by_radio.at(radio), radio);
  }
  return clearest;
}

}  // namespace fleetproof
