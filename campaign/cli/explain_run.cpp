#include "campaign/cli/explain_run.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "campaign/cli/campaign_words.hpp"
#include "campaign/cli/explained_pages.hpp"
#include "campaign/cli/interrupts.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/shrink/shrink.hpp"
#include "core/base/error.hpp"
#include "core/scenario/canonical_bytes.hpp"
#include "storage/archive_reader.hpp"

namespace fleetproof::cli {
namespace {

constexpr double kShareOfPages = 0.15;  // of the time
constexpr int kCpuOfACase_s = 20;

// The smallest case takes half of the time at most: what can be said of it matters more than how small it is.
ShrinkResult search(const ExplainLimits& limits, const CaseHost& host, const CaseSource& source, const WorkTime& time,
                    const FailingCase& original, const FailurePattern& pattern) {
  TrialCache cache;
  ShrinkResult small;
  {
    const TimeLimit limit(time.half_of_rest(), is_interrupted);
    CaseHost searching = host.within(limit);
    small = shrink(searching, cache, original, pattern, {limits.trials}, [](const FailingCase&, std::string_view) {});
  }
  const TimeLimit limit(time.end_before(0.0), is_interrupted);
  if (scenario_digest(small.best.scenario) != scenario_digest(original.scenario))
    require_steady(host.within(limit), source, small.best, pattern);
  return small;
}

}  // namespace

Explanation explained(const ExplainLimits& limits, const CaseHost& host, const CaseSource& source, const WorkTime& time,
                      const FailingCase& original, WorkProgress& progress) {
  const double for_pages_s = limits.with_pages ? kShareOfPages * time.allowed_s() : 0.0;
  const TimeLimit limit(time.end_before(for_pages_s), is_interrupted);
  CaseHost within = host.within(limit);
  ShrinkResult small;
  small.best = original;
  small.ended = true;
  FailurePattern pattern{original.failure.kind};
  try {
    progress.begin("learning what its agents say when nothing fails");
    pattern = pattern_of(within, original);
    progress.begin("looking for the smallest case");
    small = search(limits, host, source, time, original, pattern);
  } catch (const GivenUp&) {  // then the case is the run itself
  }
  return explain(within, original, small, pattern, [&](std::string_view question) { progress.begin(question); });
}

void keep_for_page(const CaseWords& words, const CaseSource& source, const Explanation& explanation) {
  if (words.run.empty() || !source.stored || is_interrupted()) return;
  if (explanation.original.digest != source.stored->digest) return;  // other software, or another run of it
  const ArchiveReader archive(words.source, Checksums::Ignore);
  const auto run = std::stoull(words.run);
  const std::string path = explained_path(words.source, run, words.failure);
  const auto found = explained_run(explanation, explained_name(archive.campaign(), run, *source.stored, words.failure));
  const auto is_better = [](const web::ExplainedRun& kept) { return kept.is_whole && !kept.lines.empty(); };
  if (found.is_whole || !is_better(kept_explained(path, found.of))) keep_explained(path, found);
}

void explain_unless_kept(const std::string& archive, std::uint64_t run) {
  try {
    CaseWords words;
    words.verb = "explain";
    words.source = archive;
    words.run = fmt::format("{}", run);
    AgentPrograms programs;
    const CaseSource source = read_case(words, programs);
    if (!source.stored) return;
    const std::string of =
        explained_name(ArchiveReader(archive, Checksums::Ignore).campaign(), run, *source.stored, {});
    if (!kept_explained(explained_path(archive, run, {}), of).lines.empty()) return;
    const int workers = worker_count(std::nullopt);
    const WorkTime time(fmt::format("{}", std::max(1, kCpuOfACase_s / workers)));
    const CaseHost host(source.agent, programs, workers);
    WorkProgress progress(
        fmt::format("explain {}", run), [&] { return host.simulated(); }, time.allowed_s());
    const ExaminedCase examined = failing_case(host, source, time);
    Explanation explanation = explained({}, host.looking_at(examined.choice), source, time, examined.failing, progress);
    explanation.shapes = shapes_of(explanation.small, source.agent, programs);
    keep_for_page(words, source, explanation);
  } catch (const InputError& error) {
    talk("why run {} failed was not found out: {}\n", run, error.what());
  } catch (const GivenUp&) {
    talk("why run {} failed was not found out: the time was over\n", run);
  }
}

}  // namespace fleetproof::cli
