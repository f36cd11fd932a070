#include "reports/html/section_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <tuple>

#include "reports/html/quality_maps.hpp"
#include "reports/wording.hpp"

namespace fleetproof::html {
namespace {

constexpr std::size_t kMostRows = 500, kShortTable = 8;

Table tally_columns(const char* what) {
  Table table;
  table.columns = {{"agent", false}, {what, false}, {"region", false}};
  for (const auto* head : {"runs", "viol.", "contact", "stuck", "crash/hang", "closest", "done/AGV-h"})
    table.columns.push_back({head});
  return table;
}

Section tally_section(const ReportInput& input, const char* what,
                      const std::function<std::string(const CellRecord&)>& name_of_cell) {
  const auto& evidence = input.evidence;
  std::map<std::tuple<std::string, std::string, bool>, Tally> rows;
  std::vector<std::tuple<std::string, std::string, bool>> order;
  for (const auto& cell : evidence.cells()) {
    const std::tuple key{cell.agent, name_of_cell(cell), !cell.in_contract()};
    const auto [place, is_new] = rows.try_emplace(key);
    if (is_new) order.push_back(key);
    place->second.add(evidence.tally(cell.index));
  }
  const auto agents = agents_in_order(evidence);
  std::ranges::stable_sort(order, {}, [&](const auto& key) { return std::ranges::find(agents, std::get<0>(key)); });
  Section section{fmt::format("By {}", what), tally_columns(what), {}};
  for (const auto& key : order) {
    if (section.table.rows.size() == kMostRows) break;
    const auto& [agent, name, beyond] = key;
    const Tally& tally = rows.at(key);
    std::vector<std::string> row{printable(agent, 40), printable(name, 40), beyond ? "beyond contract" : "contract"};
    for (const auto count :
         {tally.runs, tally.violating_runs, tally.contact_runs, tally.stuck_runs, tally.crash_runs + tally.hang_runs})
      row.push_back(std::to_string(count));
    row.push_back(clearance_text(tally));
    row.push_back(per_hour_text(tally.transports_per_agv_hour()));
    section.table.rows.push_back(std::move(row));
  }
  if (order.size() > kMostRows)
    section.remarks.emplace_back().text = fmt::format("{} more rows are left out here.", order.size() - kMostRows);
  return section;
}

}  // namespace

Element titled(const std::string& title) {
  Element section("section");
  return section.add(text_element("h2", title));
}

Element paragraph(const std::string& text) { return text_element("p", text); }

Element table_of(const Table& table) {
  Element head("tr"), body("tbody");
  const auto side = [&](std::size_t c) { return table.columns[c].right_aligned ? "right" : "left"; };
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    head.add(text_element("th", table.columns[c].head, {{"align", side(c)}, {"scope", "col"}}));
  for (std::size_t r = 0; r < std::min(table.rows.size(), kMostRows); ++r) {
    Element row("tr");
    for (std::size_t c = 0; c < table.columns.size(); ++c)
      row.add(text_element("td", table.rows[r][c], {{"align", side(c)}}));
    body.add(row);
  }
  Element whole("table", {{"class", table.rows.size() > kShortTable ? "long" : "short"}, {"cellpadding", "4"}});
  return Element("div", {{"class", "scroll"}}).add(whole.add(Element("thead").add(head)).add(body));
}

Element item_of(const Remark& remark) {
  Element item("li");
  item.text(remark.text);
  if (!remark.command.empty()) item.add(Element("pre").add(text_element("code", remark.command)));
  return item;
}

Element section_of(const Section& section) {
  Element element = titled(section.title);
  if (!section.table.columns.empty() && !section.table.rows.empty()) element.add(table_of(section.table));
  if (section.remarks.empty()) return element;
  Element list("ul");
  for (const Remark& remark : section.remarks) list.add(item_of(remark));
  return element.add(list);
}

Element headline_of(const Headline& headline) {
  std::string kind = "warning";
  if (headline.word == "demonstrated") kind = "demonstrated";
  if (headline.word == "violated" || headline.word == "violation" || headline.word == "engine error") kind = "violated";
  if (headline.word == "not demonstrated") kind = "open";
  Element block("div", {{"class", "headline " + kind}});
  block.add(text_element("strong", headline.word, {{"class", "word"}}));
  block.add(paragraph(headline.text));
  if (headline.details.empty()) return block;
  Element list("ul");
  for (const Remark& detail : headline.details) list.add(item_of(detail));
  return block.add(list);
}

Section layout_table(const ReportInput& input) {
  return tally_section(input, "layout", [](const CellRecord& cell) { return cell.layout; });
}

Section fleet_table(const ReportInput& input) {
  return tally_section(input, "fleet size",
                       [](const CellRecord& cell) { return fmt::format("{} AGVs", cell.fleet_size); });
}

}  // namespace fleetproof::html
