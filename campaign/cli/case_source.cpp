#include "campaign/cli/case_source.hpp"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>

#include "campaign/cli/campaign_words.hpp"
#include "campaign/cli/failure_words.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/plan/plan_text.hpp"
#include "campaign/plan/scenario_source.hpp"
#include "campaign/run/case_file.hpp"
#include "campaign/run/engine_identity.hpp"
#include "campaign/shrink/repetitions.hpp"
#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "core/scenario/canonical_bytes.hpp"
#include "reports/page/wording.hpp"
#include "storage/archive_reader.hpp"

namespace fleetproof::cli {
namespace {

std::uint64_t run_number(const std::string& word) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc() || end != word.data() + word.size())
    throw InputError("RUN", fmt::format("{} is no run index; name a run of the campaign", in_quotes(word)));
  return number;
}

CaseSource of_run(const CaseWords& words, AgentPrograms& programs) {
  const ArchiveReader archive(words.source, Checksums::Ignore);
  const CampaignPlan plan = parse_plan(archive.campaign().plan_json);
  const std::uint64_t run = run_number(words.run);
  if (run >= plan.run_count())
    throw InputError("RUN", fmt::format("{} does not exist; the campaign has runs 0 to {}", run, plan.run_count() - 1));
  const AgentFactor& agent = plan.agent_of_cell(run);
  meet_plugins(words.source, archive.campaign(), {&agent, 1}, words.plugins, programs, &AgentPrograms::know);
  tell_rebuilt_plugins(archive.campaign(), {&agent, 1}, programs);
  CaseSource source;
  if (auto stored = archive.run(run)) source.stored = std::move(stored->outcome);
  if (archive.recording(run)) source.recording = replay_command(words.source, run);
  source.name = fmt::format("{}-{}", std::filesystem::path(words.source).stem().string(), run);
  source.command = fmt::format("{} {}", shell_word(words.source), run);
  source.scenario = ScenarioSource(plan).scenario(run);
  source.agent = case_agent(plan, agent);
  return source;
}

CaseSource of_file(const CaseWords& words, AgentPrograms& programs) {
  refuse_results(words.source,
                 fmt::format("name a run of it: fleetproof {} {} RUN", words.verb, shell_word(words.source)));
  CaseSource source;
  source.scenario = read_case_file(words.source);
  take_computer_programs(source.scenario, words.computers, words.source);
  source.name = std::filesystem::path(words.source).stem().string();
  source.command = shell_word(words.source);
  std::vector<std::string> plugins = words.plugins;
  const std::string& named = words.agent.empty() ? source.scenario.agent : words.agent;
  source.agent.program = meet_agent(named, plugins, programs, &AgentPrograms::know, words.global_symbols);
  source.agent.config = words.config.empty() ? source.scenario.agent_config : words.config;
  source.agent.laws_left_out = source.scenario.law.leave_out;
  source.agent.computers =
      computer_parts(source.scenario, plugins, programs, &AgentPrograms::know, words.global_symbols);
  if (source.agent.program.empty())
    throw InputError("--agent", "neither the scenario file nor the command line names an agent; name one");
  return source;
}

std::string recording_text(const CaseSource& source) {
  if (!source.recording.empty()) return "; play what it did in the campaign: " + source.recording;
  return source.stored ? "; the campaign has no recording of what it did" : "";
}

// The failure that was meant does not come again, or not each time.
std::string unsteady_text(const CaseSource& source, const RunFailure& meant, const Repetitions& repetitions) {
  const char* where = source.stored ? "in the campaign" : "when it was simulated first";
  const char* why = repetitions.alike == 0 && repetitions.otherwise.size() == 1
                        ? "the software differs, or does not always do the same"
                        : "its agent does not always do the same";
  return fmt::format("failed {} with {}; {}: {}{}", where, told(meant), repetitions.text(), why,
                     recording_text(source));
}

}  // namespace

void add_case_options(Options& options, CaseWords& words) {
  options.positional("CASE", words.source, "results file, with the index of a failing run; or a scenario file");
  options.optional_positional("RUN", words.run, "run index");
  options.option("--agent", words.agent, "of a scenario file: the control software (default: the file's)");
  options.option("--agent-config", words.config, "of a scenario file: text handed to the agent (default: the file's)");
  add_failure_option(options, words.failure);
  options.option(
      "--plugin", words.plugins,
      "shared object or \"lockstep:COMMAND\" of an agent (default: what the campaign used); may be repeated");
  add_computer_option(options, words.computers);
  add_symbols_option(options, words.global_symbols);
}

CaseSource read_case(const CaseWords& words, AgentPrograms& programs) {
  choice_of(words.failure);
  const bool is_run = !words.run.empty();
  if (is_run && (!words.agent.empty() || !words.config.empty()))
    throw InputError("--agent", "a run has its agent and its configuration; leave --agent and --agent-config out");
  if (is_run && !words.computers.empty())
    throw InputError("--computer", "the campaign names the programs of the computers of a run; leave it out");
  if (is_run && words.global_symbols)
    throw InputError("--global-symbols", "the campaign says which symbols the agent of a run needs; leave it out");
  CaseSource source = is_run ? of_run(words, programs) : of_file(words, programs);
  source.failure = words.failure;
  source.scenario.expected = {};
  const bool names_agent = is_run || words.agent.empty();  // the file, not the command line
  const std::string where = names_agent ? words.source + ": /agent" : "--agent";
  const AgentFactor agent = factor_of(source.agent);
  source.identity = fmt::format("{:016x} {}", scenario_digest(source.scenario), engine_identity().program_sha256);
  for (const AgentProgram* part : programs.parts_of(agent, where)) {
    require_room(*part, *source.scenario.map, source.scenario.agvs.size(), "the scenario", where);
    source.identity += fmt::format(" {} {}", part->name, part->is_built_in() ? "built in" : part->source.sha256);
  }
  require_distribution(programs.program(agent.program, where), !source.scenario.open_orders.empty(),
                       !source.scenario.computers.empty(), where);
  programs.require_computers(agent, source.scenario, words.source + ": ");
  refuse_idle_symbols(words.global_symbols, agent, programs);
  source.plugin = plugin_options(agent, programs);
  for (const ProgramPart* part : agent.parts()) {
    const std::string& config = part->config ? *part->config : source.agent.config;
    source.identity += fmt::format(" {:016x}", name_hash(config));
  }
  return source;
}

ExaminedCase failing_case(const CaseHost& host, const CaseSource& source, const WorkTime& time) {
  const TimeLimit limit(time.end_before(0.0), is_interrupted);
  const CaseHost within = host.within(limit);
  const auto began = TimeLimit::Clock::now();
  const Outcome reference = source.stored ? *source.stored : within.in_fresh_process(source.scenario, 0).outcome;
  ExaminedCase found;
  found.choice = choice_of(source.failure, reference);
  const auto meant = chosen_failure(reference, found.choice);
  if (!meant) {
    throw InputError(source.name, source.stored ? "does not fail: nothing went wrong in it; name a run that fails"
                                                : "does not fail: nothing went wrong when it was simulated; name a run "
                                                  "that fails");
  }
  std::optional<FailingCase> first;
  bool is_steady = true;
  const auto repetitions = repeated(within.looking_at(found.choice), source.scenario, [&](const CaseRun& run) {
    const auto chosen = chosen_failure(run.outcome, found.choice);
    if (!chosen || !is_same_failure(*chosen, *meant)) return false;
    if (!first) first = FailingCase{source.scenario, *failure_of(run), run.outcome.digest};
    is_steady = is_steady && run.outcome.digest == first->digest;
    return true;
  });
  if (!repetitions.always_alike()) throw InputError(source.name, unsteady_text(source, *meant, repetitions));
  if (!is_steady)
    talk("note: {} failed so each time, but no two runs were the same; what is found may come about by chance\n",
         source.name);
  found.failing = *std::move(first);
  found.others = others_line(reference, *meant, OptionNamed::Yes);
  const std::chrono::duration<double> took = TimeLimit::Clock::now() - began;
  found.run_s = took.count() / static_cast<double>(repetitions.of + (source.stored ? 0 : 1));
  return found;
}

void require_steady(const CaseHost& host, const CaseSource& source, const FailingCase& found,
                    const FailurePattern& pattern) {
  if (source.plugin.empty()) return;
  const auto repetitions =
      repeated(host, found.scenario, [&](const CaseRun& run) { return pattern.match(run).has_value(); });
  if (repetitions.always_alike()) return;
  throw InputError(source.name,
                   fmt::format("has no smaller case that always fails so: {}, of {}. Its agent does not always do the "
                               "same{}",
                               repetitions.text(), text_of(pattern.kind), recording_text(source)));
}

}  // namespace fleetproof::cli
