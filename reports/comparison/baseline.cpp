#include "reports/comparison/baseline.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "reports/comparison/comparison_page.hpp"
#include "reports/evidence/rounding.hpp"
#include "reports/page/wording.hpp"

namespace fleetproof {
namespace {

std::optional<std::string> partner_of(const std::string& agent, const ArchiveReader& baseline) {
  if (std::ranges::find(baseline.cells(), agent, &CellRecord::agent) != baseline.cells().end()) return agent;
  const auto under_test = agents_to_compare(baseline);
  return under_test.size() == 1 ? std::optional(under_test.front()) : std::nullopt;
}

constexpr std::size_t kNewRunsListed = 10;

// Bounds of a difference in percent of the worlds: the lower is rounded down, the upper is rounded up.
std::string lower_text(double share) {
  return share < 0.0 ? "-" + rounded_up(-100.0 * share) : "+" + rounded_down(100.0 * share);
}
std::string upper_text(double share) {
  return share < 0.0 ? "-" + rounded_down(-100.0 * share) : "+" + rounded_up(100.0 * share);
}

std::string both_counts(const FailingWorlds& worlds) {
  return worlds.unknown == 0 ? std::to_string(worlds.failed) : fmt::format("{} + {}", worlds.failed, worlds.unknown);
}

std::vector<std::string> row(const std::string& agent, const EndPointChange& change) {
  return {printable(agent, 40),
          name_of(change.end_point),
          name_of(change.change),
          both_counts(change.before),
          both_counts(change.now),
          std::to_string(change.only_old),
          std::to_string(change.only_new),
          fmt::format("[{}, {}]", lower_text(change.lower), upper_text(change.upper)),
          change.worlds_needed ? std::to_string(*change.worlds_needed) : "-"};
}

void add_newly_failing(Section& section, const std::string& archive_path, const Comparison& comparison) {
  const auto& failing = comparison.newly_failing;
  section.remarks.emplace_back().text =
      fmt::format("{}: newly failing: {}; newly passing: {}.", printable(comparison.new_agent, 40),
                  count_text(failing.size(), "run"), count_text(comparison.newly_passing.size(), "run"));
  for (std::size_t i = 0; i < std::min(kNewRunsListed, failing.size()); ++i)
    section.remarks.push_back(
        {fmt::format("Newly failing: run {}", failing[i]), replay_command(archive_path, failing[i])});
  if (failing.size() > kNewRunsListed)
    section.remarks.emplace_back().text = fmt::format("{} more newly failing runs.", failing.size() - kNewRunsListed);
}

void add_comparison(Section& section, const std::string& archive_path, const BaselineComparison& baseline) {
  const Comparison& comparison = *baseline.comparison;
  for (const EndPointChange& change : comparison.end_points)
    section.table.rows.push_back(row(comparison.new_agent, change));
  std::string text = fmt::format("{}, compared with {} in {}: ", printable(comparison.new_agent, 40),
                                 printable(comparison.old_agent, 40), printable(baseline.baseline_path, 200));
  text += fmt::format("{}. Transports (orders) per AGV-hour: {:.2f} before, {:.2f} now", worlds_text(comparison),
                      comparison.old_transports_per_agv_hour, comparison.new_transports_per_agv_hour);
  for (const std::string& doubt : comparison.doubts) text += fmt::format(". Doubt: {}", doubt);
  section.remarks.emplace_back().text = text + ". All cells count here, those beyond the contract region, too.";
  if (comparison.same_worlds) add_newly_failing(section, archive_path, comparison);
}

}  // namespace

std::vector<BaselineComparison> compare_with_baseline(const ReleaseFile& now, const ReleaseFile& baseline) {
  const auto read = [](const ReleaseFile& file, const std::string& agent) {
    ReleaseRuns release = read_release(file.archive, file.path, agent);
    release.head = file.head;
    return release;
  };
  std::vector<BaselineComparison> list;
  for (const std::string& agent : agents_to_compare(now.archive)) {
    BaselineComparison& one = list.emplace_back();
    one.agent = agent;
    one.baseline_path = baseline.path;
    one.baseline_head = baseline.head;
    if (const auto partner = partner_of(agent, baseline.archive))
      one.comparison = compare(read(baseline, *partner), read(now, agent), one.rule);
  }
  return list;
}

Section comparison_section(const std::vector<BaselineComparison>& baseline, const std::string& archive_path) {
  Section section{"Compared with the baseline", {}, {}};
  section.table.columns = {{"agent", false}, {"end point", false}, {"change", false}, {"before"},       {"now"},
                           {"only before"},  {"only now"},         {"growth in %"},   {"worlds needed"}};
  const ComparisonRule rule = baseline.front().rule;
  for (const BaselineComparison& each : baseline) {
    if (each.comparison) {
      add_comparison(section, archive_path, each);
    } else {
      section.remarks.emplace_back().text =
          fmt::format("{} is not compared: {} has no agent of this name, and not exactly one under test.",
                      printable(each.agent, 40), printable(each.baseline_path, 200));
    }
  }
  for (const Headline& line : baseline.front().baseline_head)
    section.remarks.emplace_back().text = fmt::format("The baseline | {}: {}", line.word, line.text);
  section.remarks.emplace_back().text = fmt::format(
      "before, now = worlds that failed, + those of which it is not known. only before, only now = worlds in which one "
      "release failed and the other did not. growth = interval of the growth of the share ({} confidence on either "
      "side, at any time), not adjusted for the number of end points; what is unknown counts against what is claimed. "
      "throughput: a release fails in a world in which it delivers less than 90 % of what the other one does. not "
      "worse "
      "= the growth is below the margin of {}. worlds needed = with so many the change could be told, if the shares "
      "stay as they are.",
      percent(rule.confidence), percent(rule.margin));
  return section;
}

}  // namespace fleetproof
