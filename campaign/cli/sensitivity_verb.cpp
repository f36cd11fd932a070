#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "campaign/batch/sensitivity.hpp"
#include "campaign/cli/campaign_words.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/cli/verbs.hpp"
#include "core/base/error.hpp"
#include "reports/wording.hpp"

namespace fleetproof::cli {
namespace {

struct SensitivityWords {
  std::string campaign;
  std::optional<std::uint64_t> jobs, seed, runs;
  std::vector<std::string> agents;
  bool json = false;
};

std::string cell_text(const CellRecord& cell) {
  return fmt::format("{}, {} AGVs, {}", cell.layout, cell.fleet_size, factor_spans(cell.lowest, cell.highest));
}

void put_finding(const FaultFinding& finding) {
  const std::string& agent = finding.tally.agent;
  if (finding.seen_as.empty()) return put("  {:24} missed in {}\n", agent, count_text(finding.runs, "run"));
  const std::string met = finding.probe.empty() ? "" : "; met " + finding.probe;
  if (!finding.by_rate)
    return put("  {:24} {} in run {} ({}{})\n", agent, finding.seen_as, finding.runs, cell_text(finding.cell), met);
  put("  {:24} {} in {} of {}\n", agent, finding.seen_as, finding.tally.accused.at(finding.seen_as),
      count_text(finding.runs, "run"));
}

// The sound agent beside which rates are judged, and what it was accused of itself.
void put_sound(const AgentTally& sound) {
  std::vector<std::string> parts;
  for (const auto& [name, runs] : sound.accused) parts.push_back(fmt::format("{} in {}", name, runs));
  put("{} in {}: {}\n", sound.agent, count_text(sound.runs, "run"),
      parts.empty() ? "accused of nothing" : joined(parts, ", "));
  if (sound.accused.contains("violation"))
    talk(
        "warning: {} itself is accused of violations in these worlds, as with obstacles that no agent senses; "
        "violations are compared as rates\n",
        sound.agent);
}

void put_text_of(const Sensitivity& result) {
  std::vector<std::string> missed;
  for (const FaultFinding& finding : result.faults) {
    put_finding(finding);
    if (finding.seen_as.empty()) missed.push_back(finding.tally.agent);
  }
  put_sound(result.sound);
  put("detects {} of {}{}\n", result.detected(), count_text(result.faults.size(), "planted fault"),
      missed.empty() ? "" : "; misses " + joined(missed, ", "));
}

nlohmann::ordered_json json_of(const FaultFinding& finding) {
  nlohmann::ordered_json json = {
      {"agent", finding.tally.agent}, {"detected", !finding.seen_as.empty()}, {"runs", finding.runs}};
  if (finding.seen_as.empty()) return json;
  json["seen_as"] = finding.seen_as;
  json["by_rate"] = finding.by_rate;
  if (finding.by_rate) json["accused_runs"] = finding.tally.accused.at(finding.seen_as);
  json["first"] = {{"layout", finding.cell.layout},
                   {"fleet_size", finding.cell.fleet_size},
                   {"radio", factor_spans(finding.cell.lowest, finding.cell.highest)},
                   {"probe", finding.probe}};
  return json;
}

nlohmann::ordered_json json_of(const Sensitivity& result) {
  nlohmann::ordered_json json = {{"schema_version", 1},
                                 {"detected", result.detected()},
                                 {"sound", {{"agent", result.sound.agent}, {"runs", result.sound.runs}}}};
  json["sound"]["accused_runs"] = result.sound.accused;
  json["faults"] = nlohmann::ordered_json::array();
  for (const FaultFinding& finding : result.faults) json["faults"].push_back(json_of(finding));
  return json;
}

int sensitivity(const SensitivityWords& words) {
  AgentPrograms programs;
  CampaignPlan plan = load_campaign(words.campaign, programs).plan;
  if (words.seed) plan.seed = *words.seed;
  SensitivityOptions options;
  options.workers = worker_count(words.jobs);
  options.runs = words.runs.value_or(options.runs);
  if (options.runs < 1) throw InputError("--runs", "is 0; it is at least 1");
  options.agents = words.agents;
  std::size_t done = 0;
  const Sensitivity result = measure_sensitivity(plan, programs, options, [&](const FaultFinding& finding) {
    talk("{}: {} {}\n", ++done, finding.tally.agent, finding.seen_as.empty() ? "missed" : "detected");
  });
  if (words.json) {
    put_text(printable_json(json_of(result).dump(2)) + "\n");
  } else {
    put_text_of(result);
  }
  return kDemonstrated;
}

}  // namespace

Action prepare_sensitivity(Options& options) {
  auto words = std::make_shared<SensitivityWords>();
  options.positional("CAMPAIGN", words->campaign, "campaign file (TOML)");
  options.option("--runs", words->runs, "runs of each agent, at most (default: 10000, or all of the plan)");
  options.option("--seed", words->seed, "instead of the file's seed");
  options.option("-j,--jobs", words->jobs, "worker threads (default: one per core)");
  options.option("--agent", words->agents, "this faulty agent only; may be repeated");
  options.flag("--json", words->json, "print JSON");
  return [words] { return sensitivity(*words); };
}

}  // namespace fleetproof::cli
