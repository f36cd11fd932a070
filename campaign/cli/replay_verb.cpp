#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "campaign/cli/campaign_words.hpp"
#include "campaign/cli/explained_pages.hpp"
#include "campaign/cli/failure_words.hpp"
#include "campaign/cli/output_file.hpp"
#include "campaign/cli/recorded_elsewhere.hpp"
#include "campaign/cli/run_observers.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/cli/verbs.hpp"
#include "campaign/plan/plan_text.hpp"
#include "campaign/plan/scenario_source.hpp"
#include "campaign/run/replay.hpp"
#include "campaign/watch/run_text.hpp"
#include "campaign/workers/run_host.hpp"
#include "campaign/workers/worker_logs.hpp"
#include "core/base/error.hpp"
#include "core/base/json_text.hpp"
#include "core/base/outside_text.hpp"
#include "core/outcome/run_failures.hpp"
#include "generators/scenario_file/scenario_text.hpp"
#include "reports/page/wording.hpp"
#include "storage/beside.hpp"

namespace fleetproof::cli {
namespace {

struct ReplayVerbWords {
  std::string archive, scenario_out;
  std::uint64_t run = 0;
  std::vector<std::string> plugins;
  ObserverWords observed;
  bool json = false, in_process = false, is_quiet = false;
};

constexpr std::size_t kMostPrinted = 40;  // lines of the agents that are told: a stack has up to 32

void print_json(const ReplayResult& result, const CellRecord& cell, const PrintedLines& printed) {
  const Outcome& outcome = result.recomputed.outcome;
  Json json = {{"schema_version", 1},
               {"verdict", name_of(result.verdict)},
               {"explanation", result.explanation},
               {"from_recording", result.from_recording},
               {"run", result.recomputed.run_index},
               {"agent", cell.agent},
               {"layout", cell.layout},
               {"fleet_size", cell.fleet_size}};
  for (const FactorInfo& factor : kFactors) json[std::string(factor.key)] = result.recomputed.factors[factor.id];
  json["outcome"] = name_of(outcome.outcome_class());
  json["failures"] = Json::array();
  for (const RunFailure& failure : failures_of(outcome))
    json["failures"].push_back({{"what", failure.what},
                                {"end_point", failure.end_point ? Json(name_of(*failure.end_point)) : Json(nullptr)},
                                {"at_s", to_seconds(failure.at - kStart)},
                                {"a", failure.a.valid() ? Json(failure.a.value) : Json(nullptr)},
                                {"b", failure.b.valid() ? Json(failure.b.value) : Json(nullptr)},
                                {"judged", failure.is_judged},
                                {"over", failure.is_over}});
  json["violations"] = outcome.violations.size();
  json["digest_stored"] = fmt::format("{:016x}", result.stored.outcome.digest);
  json["digest_recomputed"] = fmt::format("{:016x}", outcome.digest);
  json["printed"] = {{"log", printed.log}, {"lines", printed.lines}};
  put_text(shown_json(json));
}

// What the agents printed when the campaign simulated the run.
void tell_printed(const PrintedLines& printed) {
  if (!printed.trouble.empty()) put("  what its agents printed is not known: {}\n", printed.trouble);
  if (printed.lines.empty()) return;
  put("  the last that its agents printed in the campaign ({}):\n", printable(printed.log));
  for (const std::string& line : printed.lines) put("    {}\n", printable(line, 200));
}

// A plug-in that crashes does so in a worker process, as it did in the campaign.
Resimulate isolated_simulation(const CampaignPlan& plan, const AgentPrograms& programs) {
  return [host = std::make_shared<RunHost>(plan, programs, Hosting{})](std::uint64_t run_index) {
    auto record = (*host)(run_index);
    ensure(record.has_value(), "a replay is not abandoned");
    return *std::move(record);
  };
}

void tell_other_software(const ArchiveReader& archive, const AgentFactor& agent, const AgentPrograms& programs) {
  const std::string difference = software_difference(archive.campaign().engine, programs.parts_of(agent, "replay"));
  if (!difference.empty()) put("  note: {}\n", difference);
}

// Of the agent of the run.
void meet_agent_of(const ReplayVerbWords& words, const ArchiveReader& archive, const CampaignPlan& plan,
                   AgentPrograms& programs, MeetPlugin meet) {
  meet_plugins(words.archive, archive.campaign(), {&plan.agent_of_cell(words.run), 1}, words.plugins, programs, meet);
}

// By the software itself. A run that is watched is played here, as a worker process has recorded it.
ReplayResult replay_software(const ReplayVerbWords& words, const ArchiveReader& archive, const CampaignPlan& plan,
                             AgentPrograms& programs, TraceSink* sink) {
  RunWatch watch;
  std::string recording;
  if (sink != nullptr && !words.in_process) {
    AgentPrograms known;
    meet_agent_of(words, archive, plan, known, &AgentPrograms::know);
    const AgentFactor& agent = plan.agent_of_cell(words.run);
    recording = recorded_elsewhere(ScenarioSource(plan).scenario(words.run), case_agent(plan, agent), known);
  }
  watch.play = recording;
  meet_agent_of(words, archive, plan, programs, words.in_process ? &AgentPrograms::load : &AgentPrograms::know);
  tell_rebuilt_plugins(archive.campaign(), {&plan.agent_of_cell(words.run), 1}, programs);
  if (sink == nullptr && !words.in_process)
    return replay(archive, plan, words.run, programs, isolated_simulation(plan, programs));
  return replay(archive, words.run, programs, sink, watch);
}

// By the software, if it is at hand and the audits found nothing against it; else from the recording, if there is one.
ReplayResult replay_either_way(const ReplayVerbWords& words, const ArchiveReader& archive, const CampaignPlan& plan,
                               AgentPrograms& programs, TraceSink* sink) {
  const bool wants_software = words.in_process || !words.plugins.empty();
  if (wants_software || !archive.recording(words.run)) return replay_software(words, archive, plan, programs, sink);
  // Files about the run need all of it, as it was.
  if (sink != nullptr && !words.observed.trace.wanted()) return *replay_recording(archive, plan, words.run, sink);
  if (audits_of(archive, plan, plan.agent_of_cell(words.run)).differing == 0) {
    try {
      ReplayResult result = replay_software(words, archive, plan, programs, sink);
      if (result.verdict != ReplayVerdict::NotDeterministic) return result;
    } catch (const InputError&) {  // the software is gone: the recording is there for that
    }
  }
  return *replay_recording(archive, plan, words.run, sink);
}

void print_text(const ReplayResult& result, const CellRecord& cell, const Scenario& scenario) {
  put("{}  run {}: {}, {}, {} AGVs, {}, replicate {}\n", name_of(result.verdict), result.recomputed.run_index,
      cell.agent, cell.layout, cell.fleet_size, factors_text(result.recomputed.factors), result.recomputed.replicate);
  if (!result.explanation.empty()) put("  {}\n", result.explanation);
  if (result.from_recording)
    put("  from the recording of what its agents did; --in-process or --plugin runs the software itself\n");
  if (const auto leading = chosen_failure(result.recomputed.outcome, {})) {
    put("  failure: {}\n", told(*leading));
    const std::string others = others_line(result.recomputed.outcome, *leading, OptionNamed::No);
    if (!others.empty()) put("  {}\n", others);
  }
  put_text(outcome_text(scenario, result.recomputed.outcome));
  const bool other_outcome =
      result.verdict == ReplayVerdict::SoftwareDiffers || result.verdict == ReplayVerdict::NotDeterministic;
  if (other_outcome) put("  stored outcome: {}\n", end_of_run(result.stored.outcome));
}

// What a replay page says of a run of a campaign.
ReplayWords page_words(const ReplayVerbWords& words, const CellRecord& cell, const ArchiveReader& archive,
                       const std::optional<RunRecord>& stored) {
  ReplayWords page{
      replay_command(words.archive, words.run), {{"run", fmt::format("{}", words.run)}, {"agent", cell.agent}}, {}};
  if (!stored || !chosen_failure(stored->outcome, {})) return page;
  page.explained.command = fmt::format("fleetproof explain {} {}", shell_word(words.archive), words.run);
  page.explained.run = kept_explained(explained_path(words.archive, words.run, {}),
                                      explained_name(archive.campaign(), words.run, stored->outcome, {}));
  return page;
}

// On a replay page that does not show the run of the archive.
std::string remark_of(const ReplayResult& result) {
  if (result.verdict == ReplayVerdict::Reproduced) return {};
  return fmt::format("{}: this page does not show the run of the archive. {}", name_of(result.verdict),
                     result.explanation);
}

int replay_run(const ReplayVerbWords& words) {
  const ArchiveReader archive(words.archive, Checksums::Ignore);
  const CampaignPlan plan = parse_plan(archive.campaign().plan_json);
  const ScenarioSource source(plan);
  if (words.run >= plan.run_count()) {
    throw InputError("run",
                     fmt::format("{} does not exist; the campaign has runs 0 to {}", words.run, plan.run_count() - 1));
  }
  const CellRecord cell = source.place(words.run).cell;
  const AgentFactor& agent = plan.agent_of_cell(cell.index);
  const Scenario scenario = played_by(case_agent(plan, agent), source.scenario(words.run));
  std::optional<RunObservers> observed;
  if (words.observed.wanted()) {
    const auto stored = archive.run(words.run);
    observed.emplace(words.observed, scenario, stored ? stored->outcome.violations : std::vector<Violation>(),
                     page_words(words, cell, archive, stored));
  }
  AgentPrograms programs;
  const ReplayResult result = replay_either_way(words, archive, plan, programs, observed ? &*observed : nullptr);
  if (observed) observed->finish(result.recomputed.outcome, remark_of(result));
  if (!words.scenario_out.empty())
    write_whole({words.scenario_out, "--scenario", OutputKind::Scenario}, printable_json(to_text(scenario)));
  const PrintedLines printed = last_printed(beside(words.archive, ""), words.run, kMostPrinted);
  if (words.is_quiet) {
    // the page says it all
  } else if (words.json) {
    print_json(result, cell, printed);
  } else {
    print_text(result, cell, scenario);
    tell_printed(printed);
    if (result.verdict == ReplayVerdict::Reproduced && !result.from_recording)
      tell_other_software(archive, agent, programs);
  }
  switch (result.verdict) {
    case ReplayVerdict::Reproduced:
      return kDemonstrated;
    case ReplayVerdict::SoftwareDiffers:
    case ReplayVerdict::NotDeterministic:
      return kNotDemonstrated;
    case ReplayVerdict::Diverged:
    case ReplayVerdict::ScenarioDiffers:
      return kEngineFault;
  }
  invariant_violated("a verdict of a replay has an exit code");
}

}  // namespace

void write_case_page(const std::string& archive_path, std::uint64_t run, const std::string& path) {
  ReplayVerbWords words;
  words.archive = archive_path;
  words.run = run;
  words.observed.html = path;
  words.is_quiet = true;
  replay_run(words);
}

Action prepare_replay(Options& options) {
  auto words = std::make_shared<ReplayVerbWords>();
  options.positional("DB", words->archive, "results file");
  options.positional("RUN", words->run, "run index");
  options.option("--plugin", words->plugins,
                 "shared object or \"lockstep:COMMAND\" of an agent of that run (default: what the campaign used)");
  options.option("--scenario", words->scenario_out,
                 "also write the run's scenario to this file (see: fleetproof simulate)");
  options.flag("--in-process", words->in_process, "run the agent in this process and on one thread, for a debugger");
  options.flag("--json", words->json, "print JSON");
  add_observer_options(options, words->observed);
  return [words] { return replay_run(*words); };
}

}  // namespace fleetproof::cli
