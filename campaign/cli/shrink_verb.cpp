#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "campaign/cli/campaign_words.hpp"
#include "campaign/cli/case_source.hpp"
#include "campaign/cli/interrupts.hpp"
#include "campaign/cli/output_file.hpp"
#include "campaign/cli/progress.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/cli/verbs.hpp"
#include "campaign/cli/work_time.hpp"
#include "campaign/run/case_file.hpp"
#include "campaign/shrink/failure_pattern.hpp"
#include "campaign/shrink/shrink.hpp"
#include "campaign/shrink/trial_file.hpp"
#include "core/base/error.hpp"
#include "core/base/json_text.hpp"
#include "core/base/regular_file.hpp"
#include "core/scenario/canonical_bytes.hpp"
#include "generators/scenario_file/scenario_text.hpp"
#include "reports/page/wording.hpp"

namespace fleetproof::cli {
namespace {

constexpr std::string_view kDefaultTime = "60";
// Time is kept for so many runs, and at least such a share of all: the result is simulated again at the end, in new
// processes, which a busy machine starts late.
constexpr double kLastLooks = 3.0, kLastShare = 0.1;

struct ShrinkWords {
  CaseWords from;
  std::string out, max_time = std::string(kDefaultTime);
  std::optional<std::uint64_t> jobs, trials;
  bool json = false;
};

std::string size_text(const CaseSize& size) {
  std::string text = fmt::format("{}, {}", count_text(size.agvs, "AGV"), count_text(size.transports, "transport"));
  if (size.computers > 0) text += ", " + count_text(size.computers, "computer");
  if (size.faults > 0) text += ", " + count_text(size.faults, "fault");
  if (size.obstacles > 0) text += ", " + count_text(size.obstacles, "obstacle");
  text += size.deliveries_are_drawn ? std::string(", lost and late messages as the radio draws them")
                                    : ", " + count_text(size.deliveries, "lost or late message");
  return text + fmt::format(", {}, {:.2f} s", count_text(size.segments, "segment"), to_seconds(size.horizon));
}

Json to_json(const CaseSize& size) {
  Json json = {{"agvs", size.agvs},     {"computers", size.computers},          {"transports", size.transports},
               {"faults", size.faults}, {"obstacles", size.obstacles},          {"segments", size.segments},
               {"fates", nullptr},      {"horizon_s", to_seconds(size.horizon)}};
  if (!size.deliveries_are_drawn) json["fates"] = size.deliveries;
  return json;
}

// Whether the smallest case is known, or how to look for it further.
std::string minimal_text(const ShrinkWords& words, const ShrinkResult& result) {
  if (result.one_minimal)
    return fmt::format("1-minimal: nothing of it can be left out alone ({})", count_text(result.trials, "trial"));
  std::string text = "1-minimal: not known; " + result.why_not;
  if (!result.ended) return text;
  const bool by_trials = words.trials && result.trials >= *words.trials;
  return text + (by_trials ? "; give more --max-trials" : "; the same command goes on where this one ended");
}

void put_result(const ShrinkWords& words, const ExaminedCase& examined, const ShrinkResult& result,
                const CaseSource& source) {
  const FailingCase& original = examined.failing;
  if (words.json) {
    const Json json = {{"schema_version", 1},
                       {"failure", text_of(original.failure.kind)},
                       {"other_failures", examined.others},
                       {"at_s", to_seconds(result.best.failure.at - kStart)},
                       {"before", to_json(result.before)},
                       {"after", to_json(result.after)},
                       {"trials", result.trials},
                       {"search_ended", !result.ended},
                       {"one_minimal", result.one_minimal},
                       {"why_not", result.why_not},
                       {"case", words.out}};
    return put_text(shown_json(json));
  }
  put("{}\n", text_of(original.failure.kind));
  if (!examined.others.empty()) put("  {}\n", examined.others);
  put("  before: {}\n", size_text(result.before));
  put("  after:  {}\n", size_text(result.after));
  put("  {}\n", minimal_text(words, result));
  put("  fleetproof simulate {}{}\n", shell_word(words.out), source.plugin);
}

// What an earlier search of this case has left in the file, if it still fails in the same way.
std::optional<FailingCase> found_before(const ShrinkWords& words, CaseHost& host, const CaseSource& source,
                                        const FailurePattern& pattern) {
  if (!is_name_taken(words.out)) return std::nullopt;
  Scenario before;
  try {
    before = read_case_file(words.out);
  } catch (const InputError&) {  // of an older version, or damaged
    return std::nullopt;
  }
  const bool is_of_this_case = before.name == source.scenario.name && before.agent == source.agent.program &&
                               before.agent_config == source.agent.config;
  if (!is_of_this_case) return std::nullopt;
  before.expected = {};
  const CaseRun run = host(before);
  const auto failure = pattern.match(run);
  return failure ? std::optional(FailingCase{std::move(before), *failure, run.outcome.digest}) : std::nullopt;
}

// A search with less time must not replace what one with more time has found.
void prefer(std::optional<FailingCase> before, ShrinkResult& result) {
  if (!before || !CaseSize::of(before->scenario).is_smaller_than(result.after)) return;
  result.best = *std::move(before);
  result.after = CaseSize::of(result.best.scenario);
  result.one_minimal = false;
  result.why_not = "an earlier search has found this case, which is smaller than that of the present one";
}

void save(const ShrinkWords& words, const CaseSource& source, const FailingCase& failing) {
  Scenario scenario = played_by(source.agent, failing.scenario);
  scenario.expected = failing.expectation();
  write_whole({words.out, "--output", OutputKind::Scenario}, printable_json(to_text(scenario)));
}

// The search itself, with `host` for as long as it may take.
ShrinkResult search(const ShrinkWords& words, CaseHost& host, TrialFile& trials, const FailingCase& original,
                    const CaseSource& source, WorkProgress& progress, FailurePattern& pattern) {
  ShrinkResult result;
  result.best = original;
  result.before = result.after = CaseSize::of(original.scenario);
  result.ended = true;
  result.why_not = "the time was over before the search began";
  try {
    progress.begin("learning what its agents say when nothing fails");
    pattern = pattern_of(host, original);
    progress.begin("looking for a smaller case");
    std::string told;
    result = shrink(host, trials, original, pattern, {words.trials}, [&](const FailingCase& smaller, auto pass) {
      std::string size = size_text(CaseSize::of(smaller.scenario));
      if (size != told) progress.say(fmt::format("{}: {}", pass, size));
      told = std::move(size);
    });
    prefer(found_before(words, host, source, pattern), result);
  } catch (const GivenUp&) {  // what was found stands
  }
  return result;
}

// What an unsteady search has found is not another failure under the name of this one.
void require_the_same(const CaseHost& host, const CaseSource& source, const FailurePattern& pattern,
                      const FailingCase& original, TrialFile& trials, ShrinkResult& result) {
  if (source.plugin.empty() || scenario_digest(result.best.scenario) == scenario_digest(original.scenario)) return;
  try {
    require_steady(host, source, result.best, pattern);
  } catch (const GivenUp&) {
    result.best = original;
    result.after = result.before;
    result.why_not = "there was no time to simulate what was found again";
  } catch (const InputError&) {
    trials.remove();  // they say nothing
    throw;
  }
}

int shrink_case(ShrinkWords words) {
  const WorkTime time(words.max_time);
  AgentPrograms programs;
  const CaseSource source = read_case(words.from, programs);
  if (words.out.empty()) words.out = source.name + ".case.json";
  require_writable({words.out, "--output", OutputKind::Scenario});
  const CaseHost host(source.agent, programs, worker_count(words.jobs));
  std::optional<WorkProgress> progress;
  progress.emplace(
      "shrink", [&] { return host.simulated(); }, time.allowed_s());
  progress->begin("simulating the run again");
  const ExaminedCase examined = failing_case(host, source, time);
  TrialFile trials(words.out + ".trials", source.identity);
  const CaseHost looking = host.looking_at(examined.choice);
  FailurePattern pattern;
  ShrinkResult result;
  {
    const double last_looks_s = std::max(kLastLooks * examined.run_s, kLastShare * time.allowed_s());
    const TimeLimit limit(time.end_before(source.plugin.empty() ? 0.0 : last_looks_s), is_interrupted);
    CaseHost searching = looking.within(limit);
    result = search(words, searching, trials, examined.failing, source, *progress, pattern);
  }
  progress->begin("simulating the result again");
  const TimeLimit whole(time.end_before(0.0));
  require_the_same(looking.within(whole), source, pattern, examined.failing, trials, result);
  progress.reset();
  save(words, source, result.best);
  if (result.one_minimal) trials.remove();
  put_result(words, examined, result, source);
  return interrupted() != 0 ? exit_code_of_signal(interrupted()) : kDemonstrated;
}

}  // namespace

Action prepare_shrink(Options& options) {
  auto words = std::make_shared<ShrinkWords>();
  words->from.verb = "shrink";
  add_case_options(options, words->from);
  options.option("-o,--output", words->out, "the smallest case, a scenario file (default: NAME-RUN.case.json)");
  options.option("--max-time", words->max_time, "end after this time with the smallest case so far (default: 60 s)");
  options.option("--max-trials", words->trials, "end after so many trials; the same everywhere if --max-time suffices");
  options.option("-j,--jobs", words->jobs, "worker threads (default: one per core)");
  options.flag("--json", words->json, "print JSON");
  return [words] { return unless_given_up([&] { return shrink_case(*words); }); };
}

}  // namespace fleetproof::cli
