#include "reports/campaign_page/campaign_charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/contract.hpp"
#include "reports/campaign_page/chart.hpp"
#include "reports/campaign_page/quality_maps.hpp"
#include "reports/evidence/gate_words.hpp"
#include "reports/markup/section_tables.hpp"
#include "reports/page/wording.hpp"
#include "reports/sections/plan_conditions.hpp"

namespace fleetproof::html {
namespace {

constexpr std::size_t kMostAgents = 12;            // with charts of their own
constexpr double kDefaultSafetyDistance_m = 0.10;  // of a plan without one

Element figure_of(const std::string& caption, const Element& drawing) {
  Element figure("figure");
  figure.add(text_element("figcaption", caption));
  return figure.add(Element("div", {{"class", "scroll"}}).add(drawing));
}

std::string risk_caption(const Evidence& evidence) {
  return evidence.counts_only() ? "Failing or unknown worlds / worlds"
                                : "Failing or unknown worlds / worlds, and the upper bound of their share";
}

// The bars that are closer than the safety distance are marked. A distance above 0.5 m has no line.
BarChart clearance_chart(const ClearanceCounts& counts, const std::string& label, double safety_distance_m) {
  const auto limit = static_cast<std::size_t>(std::lround(safety_distance_m * 100.0));
  BarChart chart{label, "smallest clearance of a run (m); a bar is 1 cm wide", {}, {}, {}};
  if (limit < ClearanceCounts::kSteps) chart.line_before = 1 + limit;
  chart.line_name = distance_text(safety_distance_m);
  chart.bars.push_back({"touch", counts.contact, true});
  for (std::size_t i = 0; i < ClearanceCounts::kSteps; ++i) {
    const bool is_labelled = i > 0 && i % 10 == 0;
    chart.bars.push_back(
        {is_labelled ? fmt::format("{:.1f}", static_cast<double>(i) / 100.0) : "", counts.steps[i], i < limit});
  }
  return chart;
}

void add_tail_row(Table& table, const std::string& agent, const char* region, const ClearanceCounts& counts) {
  std::vector<std::string> row{printable(agent, 40), region, std::to_string(counts.runs()),
                               std::to_string(counts.contact)};
  for (const std::size_t limit_cm : {5U, 10U, 11U, 15U, 20U, 50U})
    row.push_back(std::to_string(counts.closer_than(limit_cm)));
  for (const std::uint64_t count : {counts.farther, counts.unmeasured}) row.push_back(std::to_string(count));
  table.rows.push_back(std::move(row));
}

std::string unmeasured_text(const ClearanceCounts& counts) {
  return counts.unmeasured > 0 ? fmt::format(", {} not measured", counts.unmeasured) : "";
}

Table tail_columns() {
  Table table;
  table.columns = {{"agent", false}, {"region", false}, {"runs"}, {"contact"}};
  for (const auto* head :
       {"< 0.05 m", "< 0.10 m", "< 0.11 m", "< 0.15 m", "< 0.20 m", "< 0.50 m", "farther", "not measured"})
    table.columns.push_back({head});
  return table;
}

CurveChart bound_chart(const ReportInput& input, const CampaignFigures& figures) {
  CurveChart chart{"Upper bounds against replicates", "complete replicates", "upper bound", {}, true, false, {}};
  const auto& gates = input.evidence.gates();
  bool hourly = false, in_percent = false;
  for (std::size_t i = 0; i < figures.bounds().size(); ++i) {
    ChartLine curve{printable(gates[i].name, 60), {}};
    const double scale = gates[i].unit == GateUnit::AgvHour ? 1.0 : 100.0;
    for (const auto& [replicates, upper] : figures.bounds()[i]) {
      if (upper > 0.0) curve.points.emplace_back(static_cast<double>(replicates), scale * upper);
    }
    if (curve.points.empty()) continue;
    curve.name += fmt::format(" (agent {}, limit {})", printable(gates[i].agent, 40), limit_text(gates[i]));
    const std::string level = "limit " + limit_text(gates[i]);
    const bool is_new = std::ranges::none_of(chart.levels, [&](const auto& known) { return known.second == level; });
    if (gates[i].limit > 0.0 && is_new) chart.levels.emplace_back(scale * gates[i].limit, level);
    (gates[i].unit == GateUnit::AgvHour ? hourly : in_percent) = true;
    chart.curves.push_back(std::move(curve));
  }
  chart.y_name += hourly && in_percent ? " (%, or per AGV-hour)" : hourly ? " (per AGV-hour)" : " (%)";
  return chart;
}

CurveChart discovery_chart(const ReportInput& input, const CampaignFigures& figures, bool of_failures) {
  const char* what = of_failures ? "kinds of failures" : "kinds of situations";
  CurveChart chart{
      std::string("Discovered ") + what, "runs of the agent", std::string(what) + " seen so far", {}, false, true, {}};
  for (const auto& agent : agents_in_order(input.evidence)) {
    const auto found = figures.agents().find(agent);
    if (found == figures.agents().end() || chart.curves.size() == kMostAgents) continue;
    const auto& seen = of_failures ? found->second.failures.first_seen : found->second.situations.first_seen;
    ChartLine curve{"agent " + printable(agent, 40), {{1.0, 0.0}}};
    for (std::size_t i = 0; i < seen.size(); ++i)
      curve.points.emplace_back(static_cast<double>(seen[i]), static_cast<double>(i + 1));
    curve.points.emplace_back(static_cast<double>(found->second.runs), static_cast<double>(seen.size()));
    curve.name += seen.empty() ? ": none"
                               : fmt::format(": {}, the last new one in run {} of {}", seen.size(), seen.back(),
                                             found->second.runs);
    chart.curves.push_back(std::move(curve));
  }
  return chart;
}

Element chart_with_legend(const std::string& caption, const CurveChart& chart) {
  Element figure = figure_of(caption, draw(chart));
  Element list("ul", {{"class", "legend"}});
  for (std::size_t i = 0; i < chart.curves.size(); ++i) {
    Element item("li");
    list.add(item.add(draw_sample(i)).text(" " + chart.curves[i].name));
  }
  return figure.add(list);
}

}  // namespace

Element map_part(const ReportInput& input, const CampaignFigures& figures) {
  Element part = titled("Failures, throughput and safe mode by radio quality");
  const auto list = quality_maps(input, figures);
  const bool counts_only = input.evidence.counts_only();
  part.add(paragraph(
      fmt::format("Thick lines: the bounds of the contract, {} loss and {:g} s delay. Beyond them a fleet may stand "
                  "still (safe mode), but a violation stays a violation. Hatched: no evidence. ",
                  percent(kContractLoss), kContractDelay_s) +
      (counts_only ? "A search gives counts, no rates."
                   : "The colour of the first map is the upper bound, not the rate: with few runs it stays high, "
                     "even without a failure.")));
  if (!counts_only) part.add(draw_ramp(Ramp::Risk, "bound 0.01 %", "bound 100 %"));
  if (list.empty()) part.add(paragraph("The campaign has no cell (test condition)."));
  for (const auto& maps : list) {
    // The maps of the first agent, which is under test if any is, show at once.
    Element agent = &maps == &list.front() ? Element("div") : fold(maps.title);
    if (&maps == &list.front()) agent.add(text_element("h3", maps.title));
    Element row("div", {{"class", "maps"}});
    row.add(figure_of(risk_caption(input.evidence), draw(maps.risk)));
    row.add(figure_of("Transports (orders) done per AGV-hour", draw(maps.throughput)));
    row.add(figure_of("Share of time in safe mode", draw(maps.safe_mode)));
    if (maps.envelope) row.add(figure_of("Guaranteed envelope: bounds that hold together", draw(maps.envelope->map)));
    agent.add(row);
    if (maps.envelope) agent.add(paragraph(maps.envelope->sentence));
    part.add(agent);
  }
  std::size_t shown = 0;
  for (const auto& maps : list) shown += maps.risk.fields.size();
  if (shown < input.evidence.conditions().size())
    part.add(paragraph("The maps of further agents are left out here; the JSON report has every condition."));
  return part;
}

Element clearance_part(const ReportInput& input, const CampaignFigures& figures) {
  Element part = titled("How close the bodies came");
  part.add(paragraph(
      "Each run counts once, with its smallest clearance; the leftmost bar holds the runs with a contact. Heights are "
      "logarithmic. Clearances above 0.5 m are not told apart. A run is \"not measured\" if the simulator met an "
      "error, or if "
      "it is not known what happened after a crash. A judge of safety looks at the lower tail: runs that only "
      "just keep the distance are close to failing."));
  const double safety_distance = safety_distance_m(input.campaign.plan_json).value_or(kDefaultSafetyDistance_m);
  Table tail = tail_columns();
  Element row("div", {{"class", "maps"}});
  std::size_t charts = 0;
  for (const auto& agent : agents_in_order(input.evidence)) {
    const auto found = figures.agents().find(agent);
    if (found == figures.agents().end()) continue;
    for (const bool inside : {true, false}) {
      const auto& counts = inside ? found->second.in_contract : found->second.beyond;
      if (counts.runs() == 0) continue;
      const char* region = inside ? "contract" : "beyond contract";
      add_tail_row(tail, agent, region, counts);
      if (charts++ >= kMostAgents) continue;
      const auto caption = fmt::format("Agent {}, {}: {}, {} never closer than 0.5 m{}", printable(agent, 40), region,
                                       count_text(counts.runs(), "run"), counts.farther, unmeasured_text(counts));
      row.add(figure_of(caption, draw(clearance_chart(counts, caption, safety_distance))));
    }
  }
  if (tail.rows.empty()) return part.add(paragraph("There are no runs yet."));
  Element drawings = fold("One chart for each agent, within the contract and beyond it").add(row);
  part.add(text_element("h3", "The lower tail: runs that came closer than ...")).add(table_of(tail));
  return part.add(drawings);
}

Element effort_part(const ReportInput& input, const CampaignFigures& figures) {
  Element part = titled("Would more runs tell more?");
  if (input.evidence.runs() == 0) return part.add(paragraph("There are no runs yet."));
  Element drawings = fold("Charts of bounds, failures and situations against the number of runs");
  if (const auto bounds = bound_chart(input, figures); !bounds.curves.empty())
    drawings.add(chart_with_legend(
        "The upper bound of each gate (acceptance criterion) as the campaign went on. It holds "
        "at every number of replicates at once. Lines on each other take turns; their numbers stand at the "
        "end.",
        bounds));
  Element row("div", {{"class", "maps"}});
  row.add(
      chart_with_legend("New kinds of failures: end point and leading failure", discovery_chart(input, figures, true)));
  row.add(chart_with_legend("New situations (probes): the names in the table of what the runs met",
                            discovery_chart(input, figures, false)));
  return part.add(drawings.add(row));
}

}  // namespace fleetproof::html
