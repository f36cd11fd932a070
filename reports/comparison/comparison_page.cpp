#include "reports/comparison/comparison_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/json_text.hpp"
#include "reports/evidence/rounding.hpp"
#include "reports/page/wording.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kRunsTold = 10, kCellsTold = 12;

// "+1.2 %", away from zero by the sign that hurts.
std::string signed_percent(double share) {
  return share < 0.0 ? "-" + rounded_down(-100.0 * share) + " %" : "+" + rounded_up(100.0 * share) + " %";
}

std::string failing_text(const FailingWorlds& worlds) {
  return worlds.unknown == 0 ? std::to_string(worlds.failed)
                             : fmt::format("{} (and {} unknown)", worlds.failed, worlds.unknown);
}

std::string line_of(const EndPointChange& change, const ComparisonRule& rule) {
  std::string text = fmt::format("  {:<11} {}: {} -> {} (only old {}, only new {}); grows by {} at most ({})",
                                 name_of(change.end_point), name_of(change.change), failing_text(change.before),
                                 failing_text(change.now), change.only_old, change.only_new,
                                 signed_percent(change.upper), percent(rule.confidence));
  if (change.worlds_needed) text += fmt::format("; {} worlds would tell", *change.worlds_needed);
  return text + "\n";
}

std::string runs_text(std::string_view title, const std::vector<std::uint64_t>& runs, const std::string& path) {
  if (runs.empty()) return fmt::format("{}: none\n", title);
  std::string text = fmt::format("{}: {}\n", title, count_text(runs.size(), "run"));
  for (std::size_t i = 0; i < std::min(kRunsTold, runs.size()); ++i)
    text += fmt::format("  -> {}\n", replay_command(path, runs[i]));
  if (runs.size() > kRunsTold) text += fmt::format("  and {} more\n", runs.size() - kRunsTold);
  return text;
}

std::string cells_text(const std::vector<CellChange>& cells) {
  if (cells.empty()) return "";
  std::string text = "cells with a change (runs that fail only in the old, only in the new release):\n";
  for (std::size_t i = 0; i < std::min(kCellsTold, cells.size()); ++i) {
    const CellRecord& cell = cells[i].cell;
    text += fmt::format("  {}, {} AGVs, {}: {}, {}\n", printable(cell.layout, 40), cell.fleet_size,
                        factor_spans(cell.lowest, cell.highest), cells[i].only_old, cells[i].only_new);
  }
  if (cells.size() > kCellsTold) text += fmt::format("  and {} more\n", cells.size() - kCellsTold);
  return text;
}

std::string release_text(const ReleaseRuns& release) {
  return fmt::format("{} in {} ({})", printable(release.agent, 40), printable(release.path, 200),
                     count_text(release.replicates.size(), "world"));
}

// What stands at the heads of both reports, once if it is the same.
std::string heads_text(const ReleaseRuns& old_release, const ReleaseRuns& new_release) {
  const auto has = [](const ReleaseRuns& release, const Headline& wanted) {
    return std::ranges::any_of(
        release.head, [&](const Headline& line) { return line.word == wanted.word && line.text == wanted.text; });
  };
  std::string text;
  for (const Headline& line : old_release.head)
    text +=
        fmt::format("{} | {}: {}\n", has(new_release, line) ? "both releases" : "old release", line.word, line.text);
  for (const Headline& line : new_release.head) {
    if (!has(old_release, line)) text += fmt::format("new release | {}: {}\n", line.word, line.text);
  }
  return text;
}

Json json_of(const EndPointChange& change) {
  return {{"end_point", name_of(change.end_point)},
          {"change", name_of(change.change)},
          {"old_failed", change.before.failed},
          {"old_unknown", change.before.unknown},
          {"new_failed", change.now.failed},
          {"new_unknown", change.now.unknown},
          {"only_old", change.only_old},
          {"only_new", change.only_new},
          {"growth_lower", change.lower},
          {"growth_upper", change.upper},
          {"worlds_needed", change.worlds_needed ? Json(*change.worlds_needed) : Json(nullptr)}};
}

Json json_of(const ReleaseRuns& release) {
  auto head = Json::array();
  for (const Headline& line : release.head) head.push_back({{"word", line.word}, {"text", line.text}});
  return {{"archive", release.path},
          {"agent", release.agent},
          {"replicates", release.replicates.size()},
          {"audited", release.audited},
          {"differing", release.differing},
          {"plan_hash", hex_text(release.campaign.plan_hash)},
          {"libraries", release.campaign.engine.libraries},
          {"required_probes", release.campaign.required_probes},
          {"audit_share", release.campaign.audit_share},
          {"head", head}};
}

}  // namespace

std::string worlds_text(const Comparison& comparison) {
  if (!comparison.other_conditions.empty())
    return fmt::format("nothing can be told: the campaigns differ in {}; run the old release under the new conditions",
                       joined(comparison.other_conditions));
  const std::string worlds = count_text(comparison.worlds, "world");
  return comparison.same_worlds ? fmt::format("both ran in the same {}", worlds)
                                : fmt::format("{} of each, drawn from other seeds: this takes more worlds", worlds);
}

std::string comparison_text(const Comparison& comparison, const ReleaseRuns& old_release,
                            const ReleaseRuns& new_release, const ComparisonRule& rule) {
  std::string text = fmt::format("fleetproof comparison\n  old: {}\n  new: {}\n", release_text(old_release),
                                 release_text(new_release));
  text += worlds_text(comparison) + "\n";
  text += heads_text(old_release, new_release);
  for (const std::string& doubt : comparison.doubts)
    text += fmt::format("doubt: {}: neither is said to be as good as the other\n", doubt);
  text += fmt::format("worlds that failed, old -> new; margin {}; not adjusted for the number of end points:\n",
                      percent(rule.margin));
  for (const EndPointChange& change : comparison.end_points) text += line_of(change, rule);
  text += fmt::format("transports per AGV-hour: {:.2f} -> {:.2f}\n", comparison.old_transports_per_agv_hour,
                      comparison.new_transports_per_agv_hour);
  if (!comparison.same_worlds) return text;
  text += cells_text(comparison.cells);
  text += runs_text("newly failing", comparison.newly_failing, new_release.path);
  return text + runs_text("newly passing", comparison.newly_passing, new_release.path);
}

std::string comparison_json(const Comparison& comparison, const ReleaseRuns& old_release,
                            const ReleaseRuns& new_release, const ComparisonRule& rule) {
  Json json = {{"schema_version", 2},
               {"old", json_of(old_release)},
               {"new", json_of(new_release)},
               {"same_worlds", comparison.same_worlds},
               {"other_conditions", comparison.other_conditions},
               {"doubts", comparison.doubts},
               {"waived", waived_json(comparison.waived)},
               {"worlds", comparison.worlds},
               {"margin", rule.margin},
               {"confidence", rule.confidence},
               {"end_points", Json::array()},
               {"old_transports_per_agv_hour", comparison.old_transports_per_agv_hour},
               {"new_transports_per_agv_hour", comparison.new_transports_per_agv_hour},
               {"cells", Json::array()},
               {"newly_failing", comparison.newly_failing},
               {"newly_passing", comparison.newly_passing}};
  for (const EndPointChange& change : comparison.end_points) json["end_points"].push_back(json_of(change));
  for (const CellChange& change : comparison.cells) {
    json["cells"].push_back({{"cell", change.cell.index},
                             {"layout", change.cell.layout},
                             {"fleet_size", change.cell.fleet_size},
                             {"only_old", change.only_old},
                             {"only_new", change.only_new}});
  }
  return shown_json(json);
}

}  // namespace fleetproof
