#include "reports/replay_page/film_event_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include "reports/replay_page/log_messages.hpp"

namespace fleetproof::web {
namespace {

constexpr std::int64_t kBefore_us = 30'000'000, kAfter_us = 5'000'000;
constexpr std::size_t kMostEvents = 250, kMostNotes = 100, kMostMessages = 600;
const std::string kRefused = "refused";  // as the trace calls it
constexpr std::uint64_t kAfterAll = std::numeric_limits<std::uint64_t>::max();

using Kind = LogLine::Kind;

class EventLines {
 public:
  explicit EventLines(const Film& film) : film_(film) {
    for (const std::size_t body : film.subject()) subject_.insert(body);
  }

  std::vector<LogLine> all() {
    for (const ActivityBar& a : film_.activities) {
      if (!subject_.contains(a.body)) continue;
      add({a.end_us, a.end_order}, Kind::Activity, a.body, "ends " + a.kind);
      add({a.begin_us, a.begin_order}, Kind::Activity, a.body, "begins " + a.kind, a.details);
    }
    for (const Declared& s : film_.states) {
      if (subject_.contains(s.body)) add({s.at_us, s.order}, Kind::Said, s.body, "its agent says", quoted(s.word));
    }
    for (const Waiting& w : film_.waits) {
      if (!subject_.contains(w.body)) continue;
      const std::string whom = w.for_whom ? "for " + film_.bodies[*w.for_whom].name : "for nobody";
      add({w.at_us, w.order}, Kind::Said, w.body, "says it waits", whom);
    }
    for (const Happening& h : film_.happenings) {
      if (h.is_note || (!h.is_fault && !subject_.contains(h.body))) continue;
      add({h.at_us, h.order}, h.is_fault ? Kind::Fault : Kind::Event, h.body, h.what, h.details);
      if (h.what == kRefused) lines_.back().alike = fmt::format("{}\n{}\n{}", h.body, h.what, h.details);
    }
    for (const TooClose& v : film_.violations)
      add({v.first_us, kAfterAll}, Kind::Failure, v.a, "too close", "to " + film_.bodies[v.b].name);
    return std::move(lines_);
  }

  // What the agents noted for their authors. Notes that are alike fold, and part no messages.
  std::vector<LogLine> notes() {
    lines_.clear();
    for (const Happening& h : film_.happenings) {
      if (!h.is_note || !subject_.contains(h.body)) continue;
      add({h.at_us, h.order}, Kind::Said, h.body, "its agent notes " + h.details);
      lines_.back().alike = fmt::format("{}\nnote\n{}", h.body, h.details);
    }
    return std::move(lines_);
  }

 private:
  static std::string quoted(const std::string& word) { return word.empty() ? "nothing" : "\"" + word + "\""; }
  void add(Moment at, Kind kind, std::size_t body, std::string what, std::string details = {}) {
    LogLine line;
    line.at = at;
    line.kind = kind;
    line.marked = kind == Kind::Fault || kind == Kind::Failure;
    line.who = film_.bodies[body].name;
    line.what = std::move(what);
    line.details = std::move(details);
    lines_.push_back(std::move(line));
  }

  const Film& film_;
  std::set<std::size_t> subject_;
  std::vector<LogLine> lines_;
};

// A flood of calls that are refused is one line, until the AGV does something else.
std::vector<LogLine> fold_refused(std::vector<LogLine> lines) {
  std::ranges::stable_sort(lines, {}, &LogLine::at);
  std::vector<LogLine> folded;
  std::map<std::string, std::size_t> last_of;  // by name of the AGV
  for (LogLine& line : lines) {
    const auto last = last_of.find(line.who);
    if (!line.alike.empty() && last != last_of.end() && folded[last->second].alike == line.alike) {
      LogLine& first = folded[last->second];
      if (first.folded.empty()) first.folded.push_back(first);
      first.folded.push_back(std::move(line));
      continue;
    }
    last_of[line.who] = folded.size();
    folded.push_back(std::move(line));
  }
  for (LogLine& line : folded) line.alike.clear();
  return folded;
}

// Of the lines in time, those nearest to the failure; returns how many are left out.
std::size_t keep_nearest(std::vector<LogLine>& lines, const EventLog& event_log, std::int64_t focus_us,
                         std::size_t most) {
  std::erase_if(
      lines, [&](const LogLine& line) { return line.at.at_us < event_log.from_us || line.at.at_us > event_log.to_us; });
  if (lines.size() <= most) return 0;
  std::ranges::stable_sort(lines, {}, [&](const LogLine& line) {
    return line.at.at_us <= focus_us ? focus_us - line.at.at_us : 4 * (line.at.at_us - focus_us);
  });
  const std::size_t gone = lines.size() - most;
  lines.resize(most);
  return gone;
}

// Lines that are alike, between two events, become one at the place of the first.
std::vector<LogLine> fold(std::vector<LogLine> lines) {
  std::vector<LogLine> folded;
  std::map<std::string, std::size_t> place_of;
  for (LogLine& line : lines) {
    if (line.alike.empty()) {
      place_of.clear();
      folded.push_back(std::move(line));
      continue;
    }
    const auto [known, fresh] = place_of.emplace(line.alike, folded.size());
    if (fresh) {
      folded.push_back(std::move(line));
      continue;
    }
    LogLine& first = folded[known->second];
    if (first.folded.empty()) first.folded.push_back(first);
    first.marked = first.marked || line.marked;
    first.folded.push_back(std::move(line));
  }
  return folded;
}

}  // namespace

EventLog event_log_of(const Film& film) {
  EventLog event_log;
  event_log.from_us = std::max<std::int64_t>(0, film.focus_us - kBefore_us);
  event_log.to_us = std::min(film.end_us, film.focus_us + kAfter_us);
  std::vector<LogLine> events = fold_refused(EventLines(film).all());
  event_log.left_out = keep_nearest(events, event_log, film.focus_us, kMostEvents);
  std::vector<LogLine> notes = EventLines(film).notes();
  event_log.left_out += keep_nearest(notes, event_log, film.focus_us, kMostNotes);
  std::vector<LogLine> messages = message_lines(film, event_log.from_us, event_log.to_us);
  event_log.left_out += keep_nearest(messages, event_log, film.focus_us, kMostMessages);
  for (std::vector<LogLine>* more : {&notes, &messages})
    events.insert(events.end(), std::make_move_iterator(more->begin()), std::make_move_iterator(more->end()));
  std::ranges::stable_sort(events, {}, &LogLine::at);
  event_log.lines = fold(std::move(events));
  return event_log;
}

}  // namespace fleetproof::web
