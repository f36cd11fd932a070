#include "reports/replay_page/differences.hpp"

#include <fmt/format.h>

#include <algorithm>
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

// Without the numbers of messages: one message more, and all later ones have others.
auto event_of(const LogLine& line) {
  const auto number = line.kind == LogLine::Kind::Message ? line.what.find(" #") : line.what.npos;
  const auto content = number == line.what.npos ? number : line.what.find(' ', number + 1);
  const std::string what = line.what.substr(0, number) + (content == line.what.npos ? "" : line.what.substr(content));
  return std::tuple(line.at.at_us, line.who, what);
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

}  // namespace

Element differences_part(const Film& failing, const Film& changed, const std::string& failing_page) {
  const std::vector<LogLine> before = unfolded(event_log_of(failing)),
                             after = unfolded(event_log_of(as_seen_from(failing, changed)));
  Rows rows(failing_page);
  for (auto one = before.begin(), other = after.begin(); one != before.end() || other != after.end();) {
    const bool are_one_event = one != before.end() && other != after.end() && event_of(*one) == event_of(*other);
    if (are_one_event && one->details != other->details) {
      rows.add(&*one++, &*other++);
    } else if (other == after.end() || (one != before.end() && key_of(*one) < key_of(*other))) {
      rows.add(&*one++, nullptr);
    } else if (one == before.end() || key_of(*other) < key_of(*one)) {
      rows.add(nullptr, &*other++);
    } else {
      rows.add_same();
      ++one;
      ++other;
    }
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
