#include "reports/replay_page/event_log_part.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "reports/markup/section_tables.hpp"
#include "reports/page/wording.hpp"

namespace fleetproof::web {
namespace {

using html::Element;
using html::text_element;

std::string class_of(const LogLine& line) {
  constexpr const char* kNames[] = {"activity", "said", "event", "fault", "failure", "message"};
  return fmt::format("line {}{}", kNames[static_cast<std::size_t>(line.kind)], line.marked ? " marked" : "");
}

void add_cells(Element& row, const LogLine& line, const std::string& what, const std::string& details) {
  row.add(text_element("span", time_text(line.at.at_us), {{"class", "at"}}));
  row.add(text_element("span", line.who, {{"class", "whose"}}));
  row.add(text_element("span", what, {{"class", "what"}}));
  row.add(text_element("span", details, {{"class", "more"}}));
}

Element plain_line(const LogLine& line) {
  Element row("div", {{"class", class_of(line)}, {"data-us", fmt::format("{}", line.at.at_us)}});
  add_cells(row, line, line.what, line.details);
  return row;
}

// The lines that are folded stand below, the first of them too.
Element folded_line(const LogLine& line) {
  const auto marked = std::ranges::count_if(line.folded, &LogLine::marked);
  // "STATE #17 (holds C2)": what they have in common is all but the number.
  const auto number = line.what.find(" #");
  const auto content = number == line.what.npos ? number : line.what.find(" (", number);
  std::string kind = line.what.substr(0, number);
  if (line.kind == LogLine::Kind::Event) kind += " " + line.details;
  const std::string details =
      fmt::format("until {} s{}", time_text(line.folded.back().at.at_us),
                  marked > 0 ? fmt::format("; {} of them lost, doubled or under way at the end", marked) : "");
  Element summary("summary", {{"class", class_of(line)}, {"data-us", fmt::format("{}", line.at.at_us)}});
  add_cells(summary, line,
            fmt::format("{} \u00d7 {}{}", kind, line.folded.size(),
                        content == line.what.npos ? "" : line.what.substr(content)),
            details);
  Element whole("details");
  whole.add(summary);
  for (const LogLine& one : line.folded) whole.add(plain_line(one));
  return whole;
}

}  // namespace

Element event_log_part(const EventLog& event_log) {
  Element part = html::titled("Event log");
  std::string words = fmt::format(
      "From {} s to {} s, cause before effect: what the AGVs involved did and said, all faults, and every message to "
      "or from an AGV involved. Messages of one kind between two events are one line: open it. Lost and doubled "
      "messages are marked.",
      time_text(event_log.from_us), time_text(event_log.to_us));
  if (event_log.left_out > 0)
    words += fmt::format(" Left out, farther from the failure: {}.", count_text(event_log.left_out, "line"));
  part.add(html::paragraph(words));
  Element list("div", {{"class", "log-lines"}, {"id", "log-lines"}});
  for (const LogLine& line : event_log.lines) list.add(line.folded.empty() ? plain_line(line) : folded_line(line));
  return part.add(list);
}

}  // namespace fleetproof::web
