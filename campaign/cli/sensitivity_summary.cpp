#include "campaign/cli/sensitivity_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>

#include "campaign/plan/plan_text.hpp"
#include "campaign/run/engine_identity.hpp"
#include "core/bridges/wrapped/fault_words.hpp"
#include "reports/page/wording.hpp"

namespace fleetproof::cli {
namespace {

constexpr double kMissed = std::numeric_limits<double>::infinity();

double median(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

// Where the fault showed: a violation in a cell, a rate with a radio or everywhere.
std::string place_of(const FaultDetection& finding) {
  if (finding.by_rate && !finding.radio) return "over all runs";
  if (finding.radio) return factor_spans(finding.radio->lowest, finding.radio->highest);
  const CellRecord& cell = finding.cell;
  return fmt::format("{}, {} AGVs, {}", cell.layout, cell.fleet_size, factor_spans(cell.lowest, cell.highest));
}

// What most detections were; of equals the first by name.
template <class Value>
Value usual(const std::map<Value, std::uint64_t>& counts) {
  return std::ranges::max_element(counts, {}, [](const auto& entry) { return entry.second; })->first;
}

// The findings of one kind: by rate, or by a violation.
std::vector<const FaultDetection*> detections(const std::vector<const FaultDetection*>& findings, bool by_rate) {
  std::vector<const FaultDetection*> alike;
  std::ranges::copy_if(findings, std::back_inserter(alike), [&](const FaultDetection* finding) {
    return !finding->seen_as.empty() && finding->by_rate == by_rate;
  });
  return alike;
}

void take_runs(PlantedFault& fault, const std::vector<const FaultDetection*>& findings) {
  std::vector<double> runs;
  for (const FaultDetection* finding : findings)
    runs.push_back(finding->seen_as.empty() ? kMissed : static_cast<double>(finding->runs));
  if (const double middle = median(runs); middle < kMissed) fault.median_runs = middle;
  if (const double most = *std::ranges::max_element(runs); most < kMissed)
    fault.most_runs = static_cast<std::uint64_t>(most);
}

// `findings`: one for each seed.
PlantedFault summary_of(const std::vector<const FaultDetection*>& findings) {
  PlantedFault fault;
  fault.agent = findings.front()->tally.agent;
  fault.sound = findings.front()->sound;
  fault.tried = std::ranges::any_of(findings, &FaultDetection::tried);
  const auto rates = detections(findings, true), violations = detections(findings, false);
  fault.seeds = rates.size() + violations.size();
  if (fault.seeds == 0) return fault;
  fault.by_rate = rates.size() > violations.size();
  const auto& alike = fault.by_rate ? rates : violations;
  std::map<std::string, std::uint64_t> seen_as;
  for (const FaultDetection* finding : alike) ++seen_as[finding->seen_as];
  fault.seen_as = usual(seen_as);
  fault.cell = place_of(*alike.front());
  fault.probe = alike.front()->probe;
  if (!fault.by_rate) take_runs(fault, findings);
  return fault;
}

// What the agent says of itself, without the words that all faulty agents begin with.
std::string fault_of(const AgentPrograms& programs, const std::string& name) {
  if (const std::string with = wrapped::split_word(name).with; !with.empty())
    return description_of(wrapped::parse_fault(with.substr(with.rfind(wrapped::kWith) + wrapped::kWith.size())));
  for (const AgentProgram& program : programs.all()) {
    if (program.name != name) continue;
    const std::size_t colon = program.description.find(": ");
    return colon == std::string::npos ? program.description : program.description.substr(colon + 2);
  }
  return {};
}

}  // namespace

SensitivityRecord summary_of(const CampaignPlan& plan, const AgentPrograms& programs,
                             const std::vector<SeededSensitivity>& measured) {
  SensitivityRecord record;
  record.worlds = worlds_of(plan_text(plan));
  record.engine_version = engine_identity().version;
  record.program_sha256 = engine_identity().program_sha256;
  const std::vector<std::string> planted = faulty_agent_names(plan);
  record.known_faults = planted.size();
  for (const auto& [seed, found] : measured) {
    record.seeds.push_back(seed);
    for (const AgentTally& tally : found.sound) {
      record.runs = std::max(record.runs, tally.all.runs);
      auto known = std::ranges::find(record.sound, tally.agent, &SoundAgent::agent);
      if (known == record.sound.end()) known = record.sound.insert(known, {.agent = tally.agent});
      known->runs += tally.all.runs;
      known->violating_runs += tally.all.with(kAccusedOfViolation);
    }
  }
  // An interrupted measurement has fewer of the last seed, or none at all.
  const std::size_t faults = measured.empty() ? 0 : measured.front().found.faults.size();
  for (std::size_t place = 0; place < faults; ++place) {
    std::vector<const FaultDetection*> findings;
    for (const auto& [seed, found] : measured) {
      if (place < found.faults.size()) findings.push_back(&found.faults[place]);
    }
    record.faults.push_back(summary_of(findings));
    if (std::ranges::find(planted, record.faults.back().agent) == planted.end()) ++record.known_faults;
    record.faults.back().text = fault_of(programs, record.faults.back().agent);
  }
  return record;
}

}  // namespace fleetproof::cli
