#include "campaign/cli/case_source.hpp"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>

#include "campaign/cli/campaign_words.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/plan/plan_text.hpp"
#include "campaign/plan/scenario_source.hpp"
#include "campaign/run/case_file.hpp"
#include "campaign/run/engine_identity.hpp"
#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "core/scenario/canonical_bytes.hpp"
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
  if (const auto stored = archive.run(run); stored && stored->outcome.outcome_class() != OutcomeClass::Clean)
    source.stored_failure = name_of(stored->outcome.outcome_class());
  source.name = fmt::format("{}-{}", std::filesystem::path(words.source).stem().string(), run);
  source.scenario = ScenarioSource(plan).scenario(run);
  source.agent = case_agent(plan, agent);
  return source;
}

CaseSource of_file(const CaseWords& words, AgentPrograms& programs) {
  refuse_results(words.source,
                 fmt::format("name a run of it: fleetproof {} {} RUN", words.verb, shell_word(words.source)));
  CaseSource source;
  source.scenario = read_case_file(words.source);
  source.name = std::filesystem::path(words.source).stem().string();
  std::vector<std::string> plugins = words.plugins;
  const std::string& named = words.agent.empty() ? source.scenario.agent : words.agent;
  source.agent.program = meet_agent(named, plugins, programs, &AgentPrograms::know);
  source.agent.config = words.config.empty() ? source.scenario.agent_config : words.config;
  source.agent.laws_left_out = source.scenario.law.leave_out;
  if (source.agent.program.empty())
    throw InputError("--agent", "neither the scenario file nor the command line names an agent; name one");
  return source;
}

}  // namespace

void add_case_options(Options& options, CaseWords& words) {
  options.positional("CASE", words.source, "results file, with the index of a failing run; or a scenario file");
  options.optional_positional("RUN", words.run, "run index");
  options.option("--agent", words.agent, "of a scenario file: the control software (default: the file's)");
  options.option("--agent-config", words.config, "of a scenario file: text handed to the agent (default: the file's)");
  options.option("--plugin", words.plugins,
                 "shared object with the agent (default: the file that the campaign used); may be repeated");
}

CaseSource read_case(const CaseWords& words, AgentPrograms& programs) {
  const bool is_run = !words.run.empty();
  if (is_run && (!words.agent.empty() || !words.config.empty()))
    throw InputError("--agent", "a run has its agent and its configuration; leave --agent and --agent-config out");
  CaseSource source = is_run ? of_run(words, programs) : of_file(words, programs);
  source.scenario.expected = {};
  const bool names_agent = is_run || words.agent.empty();  // the file, not the command line
  const AgentProgram& agent =
      programs.program(source.agent.program, names_agent ? words.source + ": /agent" : "--agent");
  if (agent.is_plugin()) source.plugin = " --plugin " + shell_word(agent.file);
  source.identity = fmt::format("{:016x} {} {} {}", scenario_digest(source.scenario), agent.name,
                                agent.is_plugin() ? agent.sha256 : "built in", engine_identity().program_sha256);
  source.identity += fmt::format(" {:016x}", name_hash(source.agent.config));
  return source;
}

FailingCase failing_case(CaseHost& host, const CaseSource& source) {
  const auto first = failure_of(host(source.scenario)), second = failure_of(host(source.scenario));
  if (!first && !source.stored_failure.empty())
    throw InputError(source.name,
                     fmt::format("does not fail any more: the campaign stores {} for this run, and nothing "
                                 "went wrong when it was simulated now; the software differs, or does not "
                                 "always do the same (see: fleetproof replay)",
                                 source.stored_failure));
  if (!first)
    throw InputError(source.name, "does not fail: nothing went wrong when it was simulated; name a run that fails");
  if (!second || !(first->kind == second->kind) || first->at != second->at) {
    throw InputError(source.name, fmt::format("fails in two ways, {} and {}: its agent does not always do the same",
                                              text_of(first->kind), second ? text_of(second->kind) : "not at all"));
  }
  return {source.scenario, *first};
}

}  // namespace fleetproof::cli
