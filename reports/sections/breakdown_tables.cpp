#include "reports/sections/breakdown_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <utility>

#include "reports/evidence/clusters.hpp"
#include "reports/evidence/gate_words.hpp"
#include "reports/evidence/rounding.hpp"
#include "reports/page/wording.hpp"
#include "reports/sections/condition_table.hpp"

namespace fleetproof {
namespace {

std::vector<Column> columns(const char* what, bool counts_only, const std::string& upper_head) {
  std::vector<Column> list{{"agent", false}, {what, false}, {"region", false}, {"runs"}};
  if (counts_only) {
    list.push_back({"viol."});
  } else {
    for (const std::string& head :
         {std::string("failed worlds"), upper_head, std::string("per AGV-h"), std::string("95 % interval")})
      list.push_back({head});
  }
  list.push_back({"stalled worlds"});
  list.push_back({"done/AGV-h"});
  return list;
}

std::vector<std::string> row(const ReportInput& input, const BreakdownRow& group, const std::string& name) {
  std::vector<std::string> cells{printable(group.key.agent, 40), name, group.key.in_contract ? "contract" : "beyond",
                                 std::to_string(group.tally.runs)};
  const UnitCount worlds = input.evidence.counted(group.violations.worlds, group.violations.cells.size());
  if (input.evidence.counts_only()) {
    cells.push_back(std::to_string(group.tally.violating_runs));
  } else {
    const GateRecord rule = bound_rule(input.evidence, group.key.agent);
    const Estimate share = estimate(rule, worlds.failing_or_unknown, worlds.counted);
    cells.push_back(fmt::format("{}/{}", failed_text(worlds.failing, worlds.failing_or_unknown), share.units));
    const bool says_nothing = worlds.counted == 0 || is_always_the_same(worlds);
    cells.push_back(says_nothing ? "-" : value_text(rule, share.upper, rounded_up));
    if (says_nothing) {
      cells.insert(cells.end(), {"-", "-"});
    } else {
      const Estimate rate = estimate(hourly_rule(rule), worlds.failing_or_unknown, worlds.counted, group.cells);
      cells.push_back(rounded_rate(*rate.rate()));
      cells.push_back(rates_text(rate.interval_95.lower, rate.interval_95.upper));
    }
  }
  cells.push_back(fmt::format("{}/{}", group.stalled, worlds.units));
  cells.push_back(per_hour_text(group.tally.transports_per_agv_hour()));
  return cells;
}

std::string upper_head(const ReportInput& input, const std::vector<BreakdownRow>& rows) {
  std::set<double> confidences;
  for (const auto& group : rows) confidences.insert(bound_rule(input.evidence, group.key.agent).confidence);
  return confidences.size() == 1 ? "upper " + percent(*confidences.begin()) : "upper";
}

// Of both tables.
std::string explanation(const ReportInput& input) {
  std::string text =
      "stalled worlds = worlds with a deadlock, livelock or starvation that is no consequence of a contact. contract, "
      "beyond = within the contract region, outside it.";
  if (input.evidence.counts_only()) return text;
  double longest_s = 0.0;
  for (const auto& group : input.breakdown.rows()) longest_s = std::max(longest_s, group.run_length_s);
  return fmt::format(
             "failed worlds = worlds with a violation in a run of this row; +N? = N more with an unknown "
             "outcome, "
             "which every rate and bound counts as failing. per AGV-h = such worlds per planned hour of one AGV; the "
             "interval holds whenever in a run they failed. A run takes up to {}. ",
             seconds_text(longest_s)) +
         text;
}

// Runs on one layout resemble each other. Says how much, and what is left for a claim about other layouts.
std::vector<std::string> layout_clusters(const ReportInput& input) {
  std::map<std::string, std::vector<Cluster>> by_agent;  // runs in the contract region, by layout
  for (const BreakdownRow& group : input.breakdown.rows()) {
    if (group.key.layout.empty() || !group.key.in_contract || group.tally.runs == 0) continue;
    by_agent[group.key.agent].push_back({group.tally.violating_runs + group.tally.unknown_runs, group.tally.runs});
  }
  std::vector<std::string> sentences;
  for (const auto& [agent, clusters] : by_agent) {
    if (clusters.size() < 2 || !is_under_test(input.evidence.plan(), agent)) continue;
    const ClusterUnits layouts = cluster_units(clusters);
    const DesignEffect effect = design_effect(clusters);
    std::string text = fmt::format("Layouts as units: runs of {} failed or stayed unknown on {} of {} layouts",
                                   printable(agent, 40), layouts.failing, layouts.units);
    if (effect.ratio)
      text += fmt::format(" (design effect, by which runs on one layout resemble each other more than chance: {:.2f})",
                          *effect.ratio);
    sentences.push_back(
        text + fmt::format(". A claim about layouts that were not run has {} units, and no more.", layouts.units));
  }
  return sentences;
}

constexpr const char* kNotAdjusted = "The intervals and bounds are not adjusted for their number.";

Section section_of(const ReportInput& input, const char* what, std::size_t most_rows,
                   const std::function<std::string(const BreakdownKey&)>& name_of) {
  Section section{fmt::format("By {}", what), {}, {}};
  const auto all = input.breakdown.rows();
  std::vector<BreakdownRow> rows;
  for (const auto& group : all) {
    if (!name_of(group.key).empty()) rows.push_back(group);
  }
  section.table.columns = columns(what, input.evidence.counts_only(), upper_head(input, rows));
  for (std::size_t i = 0; i < std::min(rows.size(), most_rows); ++i)
    section.table.rows.push_back(row(input, rows[i], name_of(rows[i].key)));
  if (!input.evidence.counts_only()) section.remarks.emplace_back().text = kNotAdjusted;
  if (rows.size() > most_rows)
    section.remarks.emplace_back().text = fmt::format("{} more rows are left out here.", rows.size() - most_rows);
  return section;
}

}  // namespace

Section layout_section(const ReportInput& input, std::size_t most_rows) {
  std::set<std::string> layouts;
  for (const auto& cell : input.evidence.cells()) layouts.insert(cell.layout);
  Section section = section_of(input, "layout", most_rows, [&](const BreakdownKey& key) -> std::string {
    if (key.fleet_size > 0) return "";
    if (!key.layout.empty()) return printable(key.layout, 40);
    return layouts.size() > 1 ? "all" : "";
  });
  Remark words;
  words.text = explanation(input);
  section.remarks.insert(section.remarks.begin(), std::move(words));
  if (input.evidence.counts_only()) return section;
  for (std::string& sentence : layout_clusters(input)) section.remarks.emplace_back().text = std::move(sentence);
  return section;
}

Section fleet_section(const ReportInput& input, std::size_t most_rows) {
  return section_of(input, "fleet size", most_rows, [](const BreakdownKey& key) {
    return key.fleet_size > 0 ? fmt::format("{} AGVs", key.fleet_size) : std::string();
  });
}

}  // namespace fleetproof
