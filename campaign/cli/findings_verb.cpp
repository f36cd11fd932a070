#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iterator>
#include <memory>
#include <set>

#include "campaign/cli/campaign_words.hpp"
#include "campaign/cli/failure_words.hpp"
#include "campaign/cli/interrupts.hpp"
#include "campaign/cli/output_file.hpp"
#include "campaign/cli/progress.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/cli/verbs.hpp"
#include "campaign/cli/work_time.hpp"
#include "campaign/explain/sentences.hpp"
#include "campaign/findings/failure_analysis.hpp"
#include "campaign/findings/findings_file.hpp"
#include "campaign/findings/refuted_needs.hpp"
#include "campaign/findings/survey.hpp"
#include "campaign/plan/plan_text.hpp"
#include "campaign/plan/scenario_source.hpp"
#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "generators/scenario_file/scenario_text.hpp"
#include "generators/text/text_file.hpp"
#include "reports/findings/mechanism_record.hpp"
#include "reports/page/wording.hpp"
#include "storage/target_file.hpp"

namespace fleetproof::cli {
namespace {

constexpr std::uint64_t kMostFailuresLookedAt = 100, kShrinkTrials = 4000;
constexpr std::size_t kTellEvery = 50, kShrunkForNeeds = 4;
constexpr std::chrono::seconds kKeepEvery{2};

struct FindingsWords {
  std::string archive, file, out, failure, max_time;
  std::vector<std::string> plugins;
  std::optional<std::uint64_t> most, jobs, trials, need_trials;
  bool add = false, json = false;
};

std::string today() { return fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::chrono::system_clock::now())); }

// One results file and the findings in it.
class FindingsOfCampaign {
 public:
  FindingsOfCampaign(const FindingsWords& words, const WorkTime& time)
      : words_(words),
        time_(time),
        limit_(time.end_before(0.0), is_interrupted),
        archive_(words.archive),
        plan_(parse_plan(archive_.campaign().plan_json)),
        file_(words.file),
        out_(words.out.empty() ? findings_path(words.archive) : words.out),
        runs_(failing_runs(archive_, plan_, words.most.value_or(kMostFailuresLookedAt), choice_of(words.failure),
                           limit_)) {
    meet_plugins(words.archive, archive_.campaign(), plan_.agents, words.plugins, programs_, &AgentPrograms::know);
    tell_rebuilt_plugins(archive_.campaign(), plan_.agents, programs_);
    if (words.add) require_writable({words.file, "--file", OutputKind::Findings});
    require_writable({out_, "--output", OutputKind::FoundFindings});
  }

  int find() {
    AgentHosts hosts(plan_, programs_, runs_.looked_at, worker_count(words_.jobs));
    {
      WorkProgress progress(
          "findings", [&] { return hosts.simulated(); }, time_.allowed_s());
      progress.say(fmt::format("looking at {} of {}, with up to {} runs for each of their failures",
                               runs_.looked_at.size(), count_text(runs_.all, "failing run"), kReplaysPerFailure));
      look(hosts, progress);
      refute(hosts, progress);
      if (words_.add) add_new(hosts, progress);
    }
    if (words_.json) {
      put_text(findings_text(record()));
    } else {
      put_lines();
    }
    write_found();
    return tell_end();
  }

 private:
  std::uint64_t trials() const { return words_.trials.value_or(kShrinkTrials); }
  const KnownIssue* kept(const Finding& finding) const { return file_.find(finding.id()); }
  const KnownFailure& representative(const Finding& finding) const { return survey_.failures[finding.representative]; }

  // The file has the findings of what was looked at so far, so that none is lost with the process.
  void look(AgentHosts& hosts, WorkProgress& progress) {
    progress.begin("failing runs looked at");
    progress.count(0, runs_.looked_at.size());
    auto kept = TimeLimit::Clock::now();
    std::size_t told = 0;
    survey_ = survey(plan_, runs_.looked_at, hosts, limit_, [&](std::size_t done, const auto& so_far) {
      progress.count(done, runs_.looked_at.size());
      if (done >= told + kTellEvery) {
        told = done / kTellEvery * kTellEvery;
        progress.say(fmt::format("{} of {} failures looked at", told, runs_.looked_at.size()));
      }
      if (TimeLimit::Clock::now() - kept < kKeepEvery) return;
      survey_ = so_far();
      group();
      kept = TimeLimit::Clock::now();
    });
    group();
  }
  void group() {
    findings_ = findings_of(survey_.failures);
    for (Finding& finding : findings_) finding.is_searched = false;
    write_found();
  }
  // A need that is told is one that was looked for in vain in runs without it.
  void refute(AgentHosts& hosts, WorkProgress& progress) {
    progress.begin("looking for runs that fail without what their finding needs");
    const ScenarioSource scenarios(plan_);
    for (Finding& finding : findings_) {
      const KnownIssue* known = kept(finding);
      if (known != nullptr) finding.refuted = known->refuted;
      if (finding.members.size() < 2) continue;  // of one failure, no needs are told
      const KnownFailure& simplest = representative(finding);
      try {
        CaseHost host = hosts.of(finding.agent).looking_at(simplest.choice).within(limit_);
        const std::vector<Scenario> smaller = known == nullptr ? std::vector<Scenario>() : cases_of(*known);
        const std::uint64_t trials = words_.need_trials.value_or(kTrialsPerNeed);
        const std::vector<Scenario> runs = runs_of(finding, scenarios);
        add_refuted_needs(host, finding, survey_.failures, {smaller, runs, trials}, finding.refuted);
        // What no trial refutes, a smaller case may.
        if (trials > 0 && !finding.has_no_needs()) {
          const auto first = std::span(runs).first(std::min(kShrunkForNeeds, runs.size()));
          const std::vector<Scenario> smallest = shrunk(host, first, trials);
          add_refuted_needs(host, finding, survey_.failures, {smallest, {}, 0}, finding.refuted);
        }
        finding.is_searched = true;
      } catch (const GivenUp&) {
        ++not_searched_;
      }
    }
    write_found();
  }
  std::vector<Scenario> runs_of(const Finding& finding, const ScenarioSource& scenarios) const {
    std::vector<Scenario> runs;
    for (const std::size_t member : finding.members) runs.push_back(scenarios.scenario(survey_.failures[member].run));
    return runs;
  }
  // Those that are kept of it. A file that is missing costs a note.
  std::vector<Scenario> cases_of(const KnownIssue& known) const {
    try {
      KeptFailure failure = file_.failure(known);
      std::vector<Scenario> cases{std::move(failure.smallest), std::move(failure.world)};
      std::ranges::move(failure.other_worlds, std::back_inserter(cases));
      return cases;
    } catch (const InputError& missing) {
      talk("note: {}: {}\n", known.id, missing.what());
      return {};
    }
  }
  void write_found() const { write_whole({out_, "--output", OutputKind::FoundFindings}, findings_text(record())); }

  int tell_end() const {
    if (limit_.is_over() && (survey_.looked_at < runs_.looked_at.size() || added_ < new_)) {
      talk("{}: {} of {} failing runs were looked at; the findings are those of these\n",
           is_interrupted() ? "interrupted" : "the time is over", survey_.looked_at, runs_.looked_at.size());
      if (words_.add) talk("{} of {} new findings were added\n", added_, new_);
    }
    if (not_searched_ > 0)
      talk("the time is over: of {}, not all needs were looked for in runs without them\n",
           count_text(not_searched_, "finding"));
    if (is_interrupted()) return exit_code_of_signal(interrupted());
    const auto is_open = [&](const Finding& f) { return needs_attention(kept(f), today()); };
    const bool all_seen = words_.add && added_ == new_;
    if (!all_seen && std::ranges::any_of(findings_, is_open)) return kViolated;
    return survey_.looked_at == runs_.looked_at.size() ? kDemonstrated : kNotDemonstrated;
  }

  void add_new(AgentHosts& hosts, WorkProgress& progress) {
    std::string text = read_text_file_if_there(words_.file).value_or("# findings: what is known about failures\n");
    for (Finding& finding : findings_) {
      if (const KnownIssue* known = kept(finding)) {
        if (finding.refuted != known->refuted) strike(text, *known, finding.refuted);
        continue;
      }
      ++new_;
      if (limit_.is_over()) continue;
      progress.say(fmt::format("{}: looking for its smallest case", finding.id()));
      progress.begin(finding.id() + ": its smallest case, its neighbours, and why it fails");
      CaseHost host = hosts.of(finding.agent).looking_at(representative(finding).choice).within(limit_);
      if (const auto added = keep_unless_over(host, finding)) {
        text += toml_of(*added);
        ++added_;
        write_file(text);  // each took long, and the next one may end with the process
      }
    }
    write_file(text);
  }
  void strike(std::string& text, const KnownIssue& known, const std::vector<std::string>& refuted) const {
    if (auto struck = with_refuted(text, known, refuted)) {
      text = std::move(*struck);
    } else {
      talk("note: {} fails without {}, too; {} is written so that this cannot be added: write \"refuted\" yourself\n",
           known.id, joined(refuted, ", "), words_.file);
    }
  }
  void write_file(const std::string& text) const { write_whole({words_.file, "--file", OutputKind::Findings}, text); }

  // What is not complete is not kept.
  std::optional<KnownIssue> keep_unless_over(CaseHost& host, Finding& finding) const {
    try {
      return keep(host, finding);
    } catch (const GivenUp&) {
      return std::nullopt;
    }
  }

  // Writes its scenarios and its explanation beside the findings file.
  KnownIssue keep(CaseHost& host, Finding& finding) const {
    const std::string id = finding.id();
    const FailureAnalysis record =
        analysis_of(host, finding, representative(finding).needs, trials(), worlds_of(finding));
    const std::vector<Scenario> smallest{record.kept.smallest};
    add_refuted_needs(host, finding, survey_.failures, {smallest, {}, 0}, finding.refuted);
    const AgentFactor& agent = plan_.agent_of_cell(representative(finding).run);
    const auto write_case = [&](const Scenario& world, const std::string& name) {
      Scenario scenario = played_by(case_agent(plan_, agent), world);
      scenario.expected = expectation_of(host(scenario));
      write_beside(name, OutputKind::Scenario, printable_json(to_text(scenario)));
    };
    KnownIssue kept{.id = id,
                    .mechanism = finding.text(),
                    .until = {},
                    .reason = {},
                    .end = finding.mechanism.end,
                    .choice = representative(finding).choice,
                    .refuted = finding.refuted,
                    .ways = record.kept.ways,
                    .doings = record.kept.doings,
                    .says = record.kept.says,
                    .found_in = finding.agent,
                    .laws_left_out = plan_.laws_left_out,
                    .limits = plan_.limits,
                    .smallest = id + ".case.json",
                    .world = id + ".world.json",
                    .neighbours = record.neighbours,
                    .whole = {{}, record.whole_runs, record.others_need}};
    write_case(record.kept.smallest, kept.smallest);
    write_case(record.kept.world, kept.world);
    const auto write_all = [&](const std::vector<Scenario>& scenarios, std::string_view what, std::size_t first,
                               std::vector<std::string>& names) {
      for (const Scenario& scenario : scenarios) {
        names.push_back(fmt::format("{}.{}-{}.json", id, what, first++));
        write_case(scenario, names.back());
      }
    };
    write_all(record.kept.other_worlds, "world", 2, kept.other_worlds);
    write_all(record.kept.runs, "run", 1, kept.whole.files);
    write_beside(id + ".md", OutputKind::Explanation, explanation_text(kept, record.explanation, agent));
    return kept;
  }

  // From the folder of the findings file, in which the commands are called.
  std::string plugin_words(const AgentFactor& agent) const {
    return plugin_options(agent, programs_,
                          std::filesystem::path(absolute_name(file_.path_beside("."))).lexically_normal().string());
  }

  std::string explanation_text(const KnownIssue& kept, const Explanation& explanation, const AgentFactor& agent) const {
    std::string text = fmt::format("# {}: {}\n\n", kept.id, printable(kept.mechanism));
    for (const std::string& sentence : sentences_of(explanation)) text += fmt::format("- {}\n", printable(sentence));
    return text + fmt::format("\n`fleetproof explain {}{} --max-trials {} --runs DIR` writes the runs in brackets.\n",
                              kept.world, plugin_words(agent), trials());
  }

  FurtherFailures worlds_of(const Finding& finding) const {
    const ScenarioSource scenarios(plan_);
    FurtherFailures worlds{others_of(finding, survey_.failures), {scenarios.scenario(representative(finding).run)}};
    for (const std::size_t member : other_members(finding, survey_.failures))
      worlds.runs.push_back(scenarios.scenario(survey_.failures[member].run));
    return worlds;
  }

  void write_beside(const std::string& name, OutputKind kind, std::string_view text) const {
    write_whole({file_.path_beside(name), "--file", kind}, text);
  }

  void put_lines() const {
    put("{}: {} of {} failing runs looked at; {}\n", words_.archive, survey_.looked_at, runs_.all,
        count_text(findings_.size(), "finding"));
    for (const Finding& finding : findings_) {
      put("\n{}  {}  {} of {}\n", finding.id(), standing_of(kept(finding), today()),
          count_text(finding.members.size(), "failure"), finding.agent);
      put("  {}\n", finding.text());
      const auto& end_point = representative(finding).end_point;
      put("  fleetproof explain {} {}{}\n", shell_word(words_.archive), representative(finding).run,
          end_point ? fmt::format(" --failure {}", name_of(*end_point)) : "");
      if (const std::string also = also_in_its_runs(finding); !also.empty()) put("  also in its runs: {}\n", also);
    }
    if (!survey_.not_again.empty())
      put("\n{} did not fail again: {}\n", count_text(survey_.not_again.size(), "run"),
          fmt::format("{}", fmt::join(survey_.not_again, ", ")));
  }

  // "F-1c2d3e4f (too close, two AGVs) in 3"
  std::string also_in_its_runs(const Finding& finding) const {
    std::set<std::uint64_t> runs;
    for (const std::size_t member : finding.members) runs.insert(survey_.failures[member].run);
    std::vector<std::string> others;
    for (const Finding& other : findings_) {
      if (&other == &finding) continue;
      const auto shared = std::ranges::count_if(
          other.members, [&](std::size_t member) { return runs.contains(survey_.failures[member].run); });
      if (shared > 0) others.push_back(fmt::format("{} ({}) in {}", other.id(), other.mechanism.end, shared));
    }
    return joined(others, ", ");
  }

  MechanismRecord record() const {
    MechanismRecord record;
    record.plan_hash = archive_.campaign().plan_hash;
    record.stored_runs = archive_.run_count();
    record.failing_runs = runs_.all;
    record.looked_at = survey_.looked_at;
    record.not_again = survey_.not_again;
    for (const Finding& finding : findings_) {
      FailureMechanism& found = record.findings.emplace_back(
          FailureMechanism{finding.id(), finding.agent, finding.text(), standing_of(kept(finding), today()),
                           needs_attention(kept(finding), today()), representative(finding).run});
      for (const std::size_t member : finding.members) found.runs.push_back(survey_.failures[member].run);
      found.refuted = finding.refuted;
    }
    return record;
  }

  const FindingsWords& words_;
  const WorkTime& time_;
  TimeLimit limit_;
  ArchiveReader archive_;
  CampaignPlan plan_;
  AgentPrograms programs_;
  FindingsFile file_;
  std::string out_;
  SurveyedRuns runs_;
  Survey survey_;
  std::vector<Finding> findings_;
  std::size_t not_searched_ = 0;     // findings of which not all needs were tried to be refuted
  std::size_t new_ = 0, added_ = 0;  // of the findings: not in the findings file, and added to it
};

int find_findings(const FindingsWords& words) {
  if (words.most && *words.most < 1) throw InputError("--max-failures", "is 0; it is at least 1");
  if (words.add && words.file.empty()) throw InputError("--add", "name the findings file with --file");
  const WorkTime time(words.max_time);
  return FindingsOfCampaign(words, time).find();
}

}  // namespace

Action prepare_findings(Options& options) {
  auto words = std::make_shared<FindingsWords>();
  options.positional("DB", words->archive, "results file");
  options.option("--file", words->file, "findings file (TOML) that says what is known, fixed or waived");
  options.flag("--add", words->add, "add what is new to it, with its smallest case and its explanation beside it");
  options.option("-o,--output", words->out,
                 "write the findings to this file (default: NAME.findings.json, where reports of NAME.db look)");
  options.option("--max-failures", words->most, "look at so many failing runs of each agent at most (default: 100)");
  add_failure_option(options, words->failure);
  options.option("--max-time", words->max_time, "end after this time with what was found, as in 90, 45m or 5h30m");
  options.option("--max-trials", words->trials, "of each smallest case, at most (default: 4000)");
  options.option("--need-trials", words->need_trials,
                 "try so many runs without each need of a finding before it is told (default: 1000)");
  options.option(
      "--plugin", words->plugins,
      "shared object or \"lockstep:COMMAND\" of an agent (default: what the campaign used); may be repeated");
  options.option("-j,--jobs", words->jobs, "worker threads (default: one per core)");
  options.flag("--json", words->json, "print JSON");
  return [words] { return unless_given_up([&] { return find_findings(*words); }); };
}

}  // namespace fleetproof::cli
