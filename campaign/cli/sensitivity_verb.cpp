#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "campaign/cli/archive_name.hpp"
#include "campaign/cli/campaign_words.hpp"
#include "campaign/cli/interrupts.hpp"
#include "campaign/cli/output_file.hpp"
#include "campaign/cli/sensitivity_summary.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/cli/verbs.hpp"
#include "campaign/cli/work_time.hpp"
#include "campaign/plan/plan_text.hpp"
#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "core/bridges/wrapped/fault_words.hpp"
#include "generators/text/text_file.hpp"
#include "reports/page/wording.hpp"
#include "reports/sensitivity/sensitivity_section.hpp"

namespace fleetproof::cli {
namespace {

struct SensitivityWords {
  std::string campaign;
  std::optional<std::uint64_t> jobs, seed, seeds, runs;
  std::vector<std::string> agents, with;
  std::string out;
  bool json = false;
};

constexpr std::uint64_t kMostSeeds = 100;
constexpr std::string_view kOneOfEach = "all";

void put_fault(const PlantedFault& fault, std::size_t seeds) {
  const std::string found = seeds == 1 ? "" : fmt::format(" with {} of {} seeds", fault.seeds, seeds);
  const char* other = wrapped::split_word(fault.agent).with.empty() ? "as the sound agent" : "as without it";
  if (!fault.tried) return put("  {:24} never tried: in each run the same {}\n", fault.agent, other);
  if (fault.seeds == 0) return put("  {:24} missed\n", fault.agent);
  if (fault.by_rate)
    return put("  {:24} {} more often than {}{} ({})\n", fault.agent, fault.seen_as, other + 3, found, fault.cell);
  const std::string runs = fault.median_runs ? fmt::format("{:g}", *fault.median_runs) : "too many";
  put("  {:24} {} after {} runs{}{} ({}{})\n", fault.agent, fault.seen_as, runs, seeds == 1 ? "" : " (median)", found,
      fault.cell, fault.probe.empty() ? "" : "; met " + fault.probe);
}

// What the sound agent, beside which rates are judged, was accused of itself.
void put_sound(const AgentTally& sound) {
  std::vector<std::string> parts;
  for (const auto& [name, runs] : sound.all.accused) parts.push_back(fmt::format("{} in {}", name, runs));
  put("{} in {}: {}\n", sound.agent, count_text(sound.all.runs, "run"),
      parts.empty() ? "accused of nothing" : joined(parts, ", "));
  if (sound.all.with(kAccusedOfViolation) > 0)
    talk(
        "warning: {} itself is accused of violations in these worlds, as with obstacles that no agent senses; "
        "violations are compared as rates\n",
        sound.agent);
}

void put_text_of(const SensitivityRecord& record, const std::vector<SeededSensitivity>& measured) {
  for (const PlantedFault& fault : record.faults) put_fault(fault, record.seeds.size());
  for (const SeededSensitivity& one : measured) std::ranges::for_each(one.found.sound, put_sound);
  put("{}\n", sensitivity_sentence(record));
}

std::vector<SeededSensitivity> measure(CampaignPlan plan, const AgentPrograms& programs,
                                       const SensitivityOptions& options, std::uint64_t seeds) {
  std::vector<SeededSensitivity> measured;
  talk("seed {}: the sound agent first, then each fault\n", plan.seed);
  for (std::uint64_t i = 0; i < seeds && !options.limit->is_over(); ++i, ++plan.seed) {
    std::size_t done = 0;
    Sensitivity found = measure_sensitivity(plan, programs, options, [&](const FaultDetection& finding) {
      talk("seed {}: {}: {} {}\n", plan.seed, ++done, finding.tally.agent,
           finding.seen_as.empty() ? "missed" : "detected");
    });
    measured.push_back({plan.seed, std::move(found)});
  }
  return measured;
}

void expect_each_once(const std::vector<std::string>& named, const char* option, const char* what) {
  for (auto one = named.begin(); one != named.end(); ++one) {
    if (std::find(named.begin(), one, *one) != one)
      throw InputError(option, fmt::format("{} is given twice; name each {} once", in_quotes(*one), what));
  }
}

std::vector<wrapped::Fault> faults_named(const std::vector<std::string>& with) {
  std::vector<wrapped::Fault> faults;
  for (const std::string& words : with) {
    try {
      const auto named = words == kOneOfEach ? wrapped::usual_faults() : std::vector{wrapped::parse_fault(words)};
      faults.insert(faults.end(), named.begin(), named.end());
    } catch (const std::invalid_argument& wrong) {
      throw InputError("--with", wrong.what());
    }
  }
  std::vector<std::string> texts;
  for (const wrapped::Fault& fault : faults) texts.push_back(text_of(fault));
  expect_each_once(texts, "--with", "fault");
  return faults;
}

// A measurement of some faults does not silently take the place of one of more.
void keep_fuller_measurement(const std::string& path, const SensitivityOptions& options, std::string_view worlds) {
  std::error_code none;
  const std::size_t named = options.agents.size() + options.with.size();
  if (named == 0 || !std::filesystem::is_regular_file(path, none)) return;
  const auto kept = parse_sensitivity(read_text_file(path));
  if (!kept || kept->worlds != worlds || kept->faults.size() <= named) return;
  const char* names = options.with.empty() ? "--agent names" : options.agents.empty() ? "--with names" : "these name";
  throw InputError(path, fmt::format("holds {} planted faults measured in these worlds, and {} {}; name "
                                     "another file with --output, or remove this one",
                                     kept->faults.size(), names, named));
}

int sensitivity(const SensitivityWords& words) {
  AgentPrograms programs;
  CampaignFile campaign = load_campaign(words.campaign, programs);
  CampaignPlan& plan = campaign.plan;
  if (words.seed) plan.seed = *words.seed;
  SensitivityOptions options;
  options.workers = worker_count(words.jobs);
  options.runs = words.runs.value_or(options.runs);
  if (options.runs < 1) throw InputError("--runs", "is 0; it is at least 1");
  options.agents = words.agents;
  const std::uint64_t seeds = words.seeds.value_or(1);
  if (seeds < 1 || seeds > kMostSeeds)
    throw InputError("--seeds", fmt::format("is {}; it is 1 to {}", seeds, kMostSeeds));
  expect_each_once(options.agents, "--agent", "agent");
  options.with = faults_named(words.with);
  const std::string usual = sensitivity_path(archive_name_of(plan.name));
  const OutputFile file{words.out.empty() ? usual : words.out, "--output", OutputKind::Sensitivity};
  require_writable(file);
  if (words.out.empty()) keep_fuller_measurement(usual, options, worlds_of(plan_text(plan)));
  listen_to_interrupts();
  const TimeLimit limit({}, is_interrupted);
  options.limit = &limit;
  try_first_worlds(plan, campaign.places);
  const auto measured = measure(plan, programs, options, seeds);
  const SensitivityRecord record = summary_of(plan, programs, measured);
  if (words.json) {
    put_text(sensitivity_text(record));
  } else {
    put_text_of(record, measured);
  }
  if (limit.is_over()) {
    talk("interrupted: the faults above were measured; no file is written\n");
    return exit_code_of_signal(interrupted());
  }
  write_whole(file, sensitivity_text(record));
  talk("{}: {}\n", shell_word(file.path),
       file.path == usual ? "a report of this campaign beside it tells this, too" : "written");
  return kDemonstrated;
}

}  // namespace

Action prepare_sensitivity(Options& options) {
  auto words = std::make_shared<SensitivityWords>();
  options.positional("CAMPAIGN", words->campaign, "campaign file (TOML)");
  options.option("--runs", words->runs, "runs of each agent, at most (default: 10000, or all of the plan)");
  options.option("--seed", words->seed, "instead of the file's seed");
  options.option("--seeds", words->seeds, "measure with so many seeds, this one and those after it (default: 1)");
  options.option("-j,--jobs", words->jobs, "worker threads (default: one per core)");
  options.option("--agent", words->agents, "this faulty agent only; may be repeated");
  options.option(
      "--with", words->with,
      "a fault around the campaign's own software, as \"stall 3 s every 60 s\", or all: one of each kind; no "
      "planted fault then; may be repeated (default: one of each kind, if software of yours is in the "
      "campaign)");
  options.option("-o,--output", words->out,
                 "write the result to this file (default: NAME.sensitivity.json, where reports of NAME.db look)");
  options.flag("--json", words->json, "print JSON");
  return [words] { return sensitivity(*words); };
}

}  // namespace fleetproof::cli
