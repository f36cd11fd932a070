#include "reports/markup/section_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "core/base/letter_case.hpp"
#include "reports/page/wording.hpp"

namespace fleetproof::html {
namespace {

constexpr std::size_t kMostRows = 500, kShortTable = 8, kFewRemarks = 4, kLongestId = 60;

// A unit stays on the line of its figure: the blank between them does not break.
std::string with_units_kept(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto is_digit = [&](std::size_t at) { return at < text.size() && text[at] >= '0' && text[at] <= '9'; };
    const bool ends = i + 2 >= text.size() || std::string_view(" .,;:)").find(text[i + 2]) != std::string_view::npos;
    const bool is_unit = i + 1 < text.size() && std::string_view("%sm").find(text[i + 1]) != std::string_view::npos;
    const bool keeps = text[i] == ' ' && i > 0 && is_digit(i - 1) && is_unit && ends;
    out += keeps ? std::string("\u00a0") : std::string(1, text[i]);
  }
  return out;
}

Element list_of(const std::vector<Remark>& remarks) {
  Element list("ul");
  for (const Remark& remark : remarks) list.add(item_of(remark));
  return list;
}

}  // namespace

std::string id_of(std::string_view title) {
  std::string id;
  for (const char c : title.substr(0, kLongestId)) {
    if (is_small(c) || is_capital(c) || (c >= '0' && c <= '9')) {
      id += to_small(c);
    } else if (!id.empty() && id.back() != '-') {
      id += '-';
    }
  }
  while (!id.empty() && id.back() == '-') id.pop_back();
  return id.empty() ? "part" : id;
}

Element titled(const std::string& title) {
  Element section("section", {{"id", id_of(title)}});
  return section.add(text_element("h2", title)).listed_as(title);
}

Element paragraph(const std::string& text) { return text_element("p", with_units_kept(text)); }

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
  item.text(with_units_kept(remark.text));
  if (!remark.command.empty()) item.add(Element("pre").add(text_element("code", remark.command)));
  return item;
}

Element section_of(const Section& section) {
  Element element = titled(section.title);
  if (!section.table.columns.empty() && !section.table.rows.empty()) element.add(table_of(section.table));
  return section.remarks.empty() ? element : element.add(list_of(section.remarks));
}

Element fold(const std::string& summary) { return Element("details").add(text_element("summary", summary)); }

Element part_of(const Section& section) {
  const std::size_t rows = section.table.columns.empty() ? 0 : section.table.rows.size();
  if (rows <= kShortTable && section.remarks.size() <= kFewRemarks) return section_of(section);
  std::string summary = rows > 0 ? count_text(rows, "row") : "";
  if (!section.remarks.empty())
    summary += (rows > 0 ? ", " : "") + count_text(section.remarks.size(), rows > 0 ? "note" : "sentence");
  Element details = fold(summary);
  if (rows > 0) details.add(table_of(section.table));
  if (!section.remarks.empty()) details.add(list_of(section.remarks));
  return titled(section.title).add(details);
}

Element folded_section_of(const Section& section, const std::string& summary) {
  if (section.remarks.size() <= kFewRemarks) return section_of(section);
  Element details = fold(summary).add(list_of(section.remarks));
  return section_of({section.title, section.table, {}}).add(details);
}

Element headline_of(const Headline& headline, const Element* inside) {
  std::string kind = "warning";
  if (headline.word == "demonstrated") kind = "demonstrated";
  if (headline.word == "violated" || headline.word == "violation" || headline.word == "engine error") kind = "violated";
  if (headline.word == "not demonstrated") kind = "open";
  Element block("div", {{"class", "headline " + kind}});
  block.add(text_element("strong", headline.word, {{"class", "word"}}));
  block.add(paragraph(headline.text));
  if (inside != nullptr) block.add(*inside);
  if (headline.details.empty()) return block;
  Element list("ul");
  for (const Remark& detail : headline.details) list.add(item_of(detail));
  return block.add(list);
}

}  // namespace fleetproof::html
