#include "reports/replay_page/differences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <tuple>
#include <vector>

#include "reports/markup/section_tables.hpp"
#include "reports/page/wording.hpp"
#include "reports/replay_page/film_event_log.hpp"

namespace fleetproof::web {
namespace {

using html::Element;
using html::text_element;

constexpr std::size_t kMostDifferences = 400;  // that differ

// Without the number of a message: one message more, and all later ones have others. A kind may have a # of its own.
std::string without_number(const std::string& what) {
  for (auto at = what.find(" #"); at != what.npos; at = what.find(" #", at + 1)) {
    const auto end = std::min(what.find_first_not_of("0123456789", at + 2), what.size());
    if (end > at + 2 && (end == what.size() || what[end] == ' ')) return what.substr(0, at) + what.substr(end);
  }
  return what;
}
auto event_of(const LogLine& line) {
  return std::tuple(line.at.at_us, line.who,
                    line.kind == LogLine::Kind::Message ? without_number(line.what) : line.what);
}
auto key_of(const LogLine& line) { return std::pair(event_of(line), line.details); }

std::vector<LogLine> unfolded(const EventLog& log) {
  std::vector<LogLine> lines;
  for (const LogLine& line : log.lines) {
    if (line.folded.empty()) {
      lines.push_back(line);
    } else {
      lines.insert(lines.end(), line.folded.begin(), line.folded.end());
    }
  }
  std::ranges::stable_sort(lines, {}, key_of);
  return lines;
}

// About the bodies of the failure, in the time around it.
Film as_seen_from(const Film& failing, Film changed) {
  changed.focus_us = failing.focus_us;
  changed.involved.clear();
  for (const std::size_t body : failing.subject()) {
    const auto same = std::ranges::find(changed.bodies, failing.bodies[body].name, &Body::name);
    if (same != changed.bodies.end())
      changed.involved.push_back(static_cast<std::size_t>(same - changed.bodies.begin()));
  }
  return changed;
}

Element cell_of(const LogLine* line) {
  if (line == nullptr) return Element("td");
  Element cell("td");
  return cell.text(fmt::format("{}: {}{}", line->who, line->what, line->details.empty() ? "" : ", " + line->details));
}

// Writes rows; what both runs have becomes one row with a number.
class Rows {
 public:
  explicit Rows(const std::string& failing_page) : failing_page_(failing_page) {}

  void add_same() {
    if (alike_ == 0) ended_difference_ = true;
    ++alike_;
  }
  void add(const LogLine* failing, const LogLine* changed) {
    put_alike();
    if (++rows_ > kMostDifferences) return;
    const std::int64_t at_us = (failing != nullptr ? failing : changed)->at.at_us;
    const bool is_first = ended_difference_ || differences_ == 0;
    Element row("tr", {{"data-us", fmt::format("{}", at_us)}});
    if (is_first) {
      row =
          Element("tr", {{"id", fmt::format("difference-{}", ++differences_)}, {"data-us", fmt::format("{}", at_us)}});
      ended_difference_ = false;
    }
    Element at("td");
    at.add(Element::link_to_page(failing_page_, fmt::format("t={}", time_text(at_us)), time_text(at_us)));
    row.add(at).add(cell_of(failing)).add(cell_of(changed));
    Element next("td");
    if (is_first) next.add(Element::link_to(fmt::format("difference-{}", differences_ + 1), "next"));
    body_.add(row.add(next));
  }
  Element body() {
    put_alike();
    // The last link leads here.
    Element end("tr", {{"id", fmt::format("difference-{}", differences_ + 1)}});
    const std::string text = rows_ > kMostDifferences
                                 ? count_text(rows_ - kMostDifferences, "more line") + " that differ"
                             : differences_ == 0 ? "No difference in the time around the failure."
                                                 : "The end.";
    return body_.add(end.add(text_element("td", text, {{"colspan", "4"}})));
  }

 private:
  void put_alike() {
    if (alike_ > 0 && rows_ <= kMostDifferences) {
      Element row("tr", {{"class", "alike"}});
      body_.add(row.add(text_element("td", count_text(alike_, "line") + " in both", {{"colspan", "4"}})));
    }
    alike_ = 0;
  }

  const std::string& failing_page_;
  Element body_{"tbody"};
  std::size_t alike_ = 0, rows_ = 0, differences_ = 0;
  bool ended_difference_ = false;
};

using Lines = std::span<const LogLine>;

// The next lines, as far as they are of this event.
template <class Event>
Lines lines_of_event(std::vector<LogLine>::const_iterator& next, std::vector<LogLine>::const_iterator end,
                     const Event& event) {
  const auto begin = next;
  next = std::find_if(next, end, [&](const LogLine& line) { return event_of(line) != event; });
  return {begin, next};
}

// Lines with equal details are alike; of the others, one of each run stand beside each other.
void add_event(Lines failing, Lines changed, Rows& rows) {
  const auto others_than = [](Lines lines, Lines other) {
    std::vector<const LogLine*> left;
    std::vector<LogLine> open(other.begin(), other.end());
    for (const LogLine& line : lines) {
      const auto same = std::ranges::find(open, line.details, &LogLine::details);
      if (same == open.end()) {
        left.push_back(&line);
      } else {
        open.erase(same);
      }
    }
    return left;
  };
  const std::vector<const LogLine*> one = others_than(failing, changed), other = others_than(changed, failing);
  for (std::size_t i = one.size(); i < failing.size(); ++i) rows.add_same();
  for (std::size_t i = 0; i < std::max(one.size(), other.size()); ++i)
    rows.add(i < one.size() ? one[i] : nullptr, i < other.size() ? other[i] : nullptr);
}

}  // namespace

Element differences_part(const Film& failing, const Film& changed, const std::string& failing_page) {
  const std::vector<LogLine> before = unfolded(event_log_of(failing)),
                             after = unfolded(event_log_of(as_seen_from(failing, changed)));
  Rows rows(failing_page);
  for (auto one = before.begin(), other = after.begin(); one != before.end() || other != after.end();) {
    const bool is_before = other == after.end() || (one != before.end() && event_of(*one) <= event_of(*other));
    const auto event = event_of(is_before ? *one : *other);
    add_event(lines_of_event(one, before.end(), event), lines_of_event(other, after.end(), event), rows);
  }
  Element part = html::titled("Beside the failing case");
  part.add(
      html::paragraph("The smallest case, and this run, in which one thing is changed. What both have is folded. An "
                      "instant leads to the "
                      "failing case at that instant, a click on a line to this run at it."));
  Element first("p");
  part.add(first.add(Element::link_to("difference-1", "To the first difference")));
  Element table("table", {{"class", "differences"}}), head("thead"), names("tr");
  for (const char* name : {"instant", "failing", "changed", ""}) names.add(text_element("th", name));
  return part.add(table.add(head.add(names)).add(rows.body()));
}

}  // namespace fleetproof::web
