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

std::string counts_text(const EndPointChange& change) {
  std::string text =
      fmt::format("{}/{} -> {}/{}", change.old_failing, change.old_worlds, change.new_failing, change.new_worlds);
  if (change.pairs) text += fmt::format(" (only old {}, only new {})", change.pairs->only_old, change.pairs->only_new);
  return text;
}

std::string line_of(const EndPointChange& change, const ComparisonRule& rule) {
  std::string text =
      fmt::format("  {:<11} {}: {}; difference {} at most ({})", name_of(change.end_point), name_of(change.change),
                  counts_text(change), signed_percent(change.one_sided_upper), percent(rule.confidence));
  if (change.change == Change::Worse) text += fmt::format(", p = {}", rounded_up(change.worse_p));
  if (change.change == Change::Improved) text += fmt::format(", p = {}", rounded_up(change.improved_p));
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

Json json_of(const EndPointChange& change) {
  Json json = {{"end_point", name_of(change.end_point)},
               {"change", name_of(change.change)},
               {"old_failing", change.old_failing},
               {"old_worlds", change.old_worlds},
               {"new_failing", change.new_failing},
               {"new_worlds", change.new_worlds},
               {"worse_p", change.worse_p},
               {"improved_p", change.improved_p},
               {"difference_lower", change.lower},
               {"difference_upper", change.upper},
               {"difference_one_sided_upper", change.one_sided_upper},
               {"worlds_needed", change.worlds_needed ? Json(*change.worlds_needed) : Json(nullptr)}};
  json["only_old"] = change.pairs ? Json(change.pairs->only_old) : Json(nullptr);
  json["only_new"] = change.pairs ? Json(change.pairs->only_new) : Json(nullptr);
  return json;
}

Json json_of(const ReleaseRuns& release) {
  return {{"archive", release.path},
          {"agent", release.agent},
          {"replicates", release.replicates.size()},
          {"plan_hash", hex_text(release.campaign.plan_hash)},
          {"libraries", release.campaign.engine.libraries}};
}

}  // namespace

std::string comparison_text(const Comparison& comparison, const ReleaseRuns& old_release,
                            const ReleaseRuns& new_release, const ComparisonRule& rule) {
  std::string text = fmt::format("fleetproof comparison\n  old: {}\n  new: {}\n", release_text(old_release),
                                 release_text(new_release));
  text += comparison.paired
              ? fmt::format("paired: both ran in the same worlds; {}\n", count_text(comparison.worlds, "world"))
              : fmt::format("not paired: {}; this takes more worlds\n", comparison.why_unpaired);
  text += fmt::format(
      "worlds that failed or stayed unknown, old -> new; margin {}; not adjusted for the number of "
      "end points:\n",
      percent(rule.margin));
  for (const EndPointChange& change : comparison.end_points) text += line_of(change, rule);
  text += fmt::format("transports per AGV-hour: {:.2f} -> {:.2f}", comparison.old_transports_per_agv_hour,
                      comparison.new_transports_per_agv_hour);
  if (!comparison.paired) return text + "\n";
  text += fmt::format(" (slower in {}, faster in {} of {} worlds)\n", comparison.slower_worlds,
                      comparison.faster_worlds, comparison.worlds);
  text += cells_text(comparison.cells);
  text += runs_text("newly failing", comparison.newly_failing, new_release.path);
  return text + runs_text("newly passing", comparison.newly_passing, new_release.path);
}

std::string comparison_json(const Comparison& comparison, const ReleaseRuns& old_release,
                            const ReleaseRuns& new_release, const ComparisonRule& rule) {
  Json json = {{"schema_version", 1},
               {"old", json_of(old_release)},
               {"new", json_of(new_release)},
               {"paired", comparison.paired},
               {"why_unpaired", comparison.paired ? Json(nullptr) : Json(comparison.why_unpaired)},
               {"worlds", comparison.worlds},
               {"margin", rule.margin},
               {"confidence", rule.confidence},
               {"end_points", Json::array()},
               {"old_transports_per_agv_hour", comparison.old_transports_per_agv_hour},
               {"new_transports_per_agv_hour", comparison.new_transports_per_agv_hour},
               {"slower_worlds", comparison.slower_worlds},
               {"faster_worlds", comparison.faster_worlds},
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
