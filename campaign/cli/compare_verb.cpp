#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "campaign/cli/campaign_end.hpp"
#include "campaign/cli/progress.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/cli/verbs.hpp"
#include "campaign/cli/waived.hpp"
#include "core/base/catalogue.hpp"
#include "core/base/error.hpp"
#include "reports/comparison/comparison_page.hpp"
#include "reports/page/wording.hpp"

namespace fleetproof::cli {
namespace {

struct CompareWords {
  std::string old_archive, new_archive, old_agent, new_agent;
  std::optional<double> margin, confidence;
  bool fail_on_regression = false, json = false;
};

// The agent that the user names, or the only one under test.
std::string agent_of(const ArchiveReader& archive, const std::string& path, const std::string& named,
                     const std::string& option, const std::string& preferred) {
  std::vector<std::string> all;
  for (const CellRecord& cell : archive.cells()) {
    if (std::ranges::find(all, cell.agent) == all.end()) all.push_back(cell.agent);
  }
  const auto has = [&](const std::string& agent) { return std::ranges::find(all, agent) != all.end(); };
  if (!named.empty()) {
    if (has(named)) return named;
    const std::vector<std::string_view> names(all.begin(), all.end());
    throw InputError(option, fmt::format("{} has no agent {}{}", path, in_quotes(named), name_hint(named, names)));
  }
  const std::vector<std::string> choices = agents_to_compare(archive);
  if (choices.size() == 1) return choices.front();
  if (!preferred.empty() && has(preferred)) return preferred;
  throw InputError(option, fmt::format("{} has more than one agent; name one of: {}", path, joined(choices)));
}

ComparisonRule rule_of(const CompareWords& words) {
  ComparisonRule rule;
  rule.margin = words.margin.value_or(rule.margin);
  rule.confidence = words.confidence.value_or(rule.confidence);
  if (!(rule.margin > 0.0 && rule.margin < 1.0))
    throw InputError("--margin", fmt::format("{:g} is refused: expected a share above 0 and below 1", rule.margin));
  if (!(rule.confidence > 0.5 && rule.confidence < 1.0))
    throw InputError("--confidence",
                     fmt::format("{:g} is refused: expected a number above 0.5 and below 1", rule.confidence));
  return rule;
}

int exit_code_of(const Comparison& comparison) {
  if (comparison.any(Change::Worse)) return kViolated;
  return comparison.any(Change::CannotTell) ? kNotDemonstrated : kDemonstrated;
}

int compare_releases(const CompareWords& words) {
  const ComparisonRule rule = rule_of(words);
  const ArchiveReader old_archive(words.old_archive), new_archive(words.new_archive);
  const std::string new_agent = agent_of(new_archive, words.new_archive, words.new_agent, "--agent", "");
  const std::string old_agent = agent_of(old_archive, words.old_archive, words.old_agent, "--old-agent", new_agent);
  auto progress = reading_progress("compare", old_archive.run_count() + new_archive.run_count());
  ReleaseRuns old_release = read_release(old_archive, words.old_archive, old_agent),
              new_release = read_release(new_archive, words.new_archive, new_agent);
  old_release.head = head_of_release(old_archive, words.old_archive);
  new_release.head = head_of_release(new_archive, words.new_archive);
  Comparison comparison = compare(old_release, new_release, rule);
  progress.reset();
  comparison.waived = lenient_conditions(new_release.campaign.plan_json);
  put_text((words.json ? comparison_json : comparison_text)(comparison, old_release, new_release, rule));
  return words.fail_on_regression ? exit_code_of(comparison) : kDemonstrated;
}

}  // namespace

Action prepare_compare(Options& options) {
  auto words = std::make_shared<CompareWords>();
  options.positional("OLD", words->old_archive, "results file of the release before");
  options.positional("NEW", words->new_archive, "results file of the new release");
  options.option("--agent", words->new_agent, "the agent of the new release (default: the one under test)");
  options.option("--old-agent", words->old_agent, "the agent of the old release (default: the one under test)");
  options.option("--margin", words->margin, "a share of worlds that the new release may be worse (default: 0.05)");
  options.option("--confidence", words->confidence, "of what is said (default: 0.95)");
  options.flag("--fail-on-regression", words->fail_on_regression,
               "end with 1 if an end point is worse, with 4 if one cannot be told");
  options.flag("--json", words->json, "print JSON");
  return [words] { return compare_releases(*words); };
}

}  // namespace fleetproof::cli
