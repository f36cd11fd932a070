#include "reports/web/film_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "reports/html/section_tables.hpp"

namespace fleetproof::web {
namespace {

using html::Element;

constexpr std::int64_t kBefore_us = 30'000'000, kAfter_us = 5'000'000;
constexpr std::size_t kMostEvents = 120, kMostMessages = 60;

// Cut, not rounded: no digit differs from the full number.
std::string time_text(std::int64_t at_us) {
  return fmt::format("{:.2f}", static_cast<double>(at_us - at_us % 10'000) / 1e6);
}
std::string millimetres_text(std::int64_t value_um) {
  return fmt::format("{:.3f}", static_cast<double>(value_um - value_um % 1000) / 1e6);
}
bool is_near(const Film& film, std::int64_t at_us) {
  return at_us >= film.focus_us - kBefore_us && at_us <= film.focus_us + kAfter_us;
}
bool is_involved(const Film& film, std::size_t body) {
  return std::ranges::find(film.involved, body) != film.involved.end();
}

// Rows of which only those nearest to the failure are shown, in order of time.
struct TimedRows {
  std::vector<std::pair<std::int64_t, std::vector<std::string>>> rows;

  void add(std::int64_t at_us, std::vector<std::string> cells) {
    cells.insert(cells.begin(), time_text(at_us));
    rows.emplace_back(at_us, std::move(cells));
  }
  std::vector<std::vector<std::string>> nearest(std::int64_t focus_us, std::size_t most) {
    std::ranges::stable_sort(rows, {}, [&](const auto& row) {
      return row.first <= focus_us ? focus_us - row.first : 4 * (row.first - focus_us);
    });
    if (rows.size() > most) rows.resize(most);
    std::ranges::stable_sort(rows, {}, [](const auto& row) { return row.first; });
    std::vector<std::vector<std::string>> cells;
    for (auto& row : rows) cells.push_back(std::move(row.second));
    return cells;
  }
};

void add_part(std::vector<Element>& parts, const std::string& title, const std::string& words, Table table) {
  if (table.rows.empty()) return;
  Element part = html::titled(title);
  if (!words.empty()) part.add(html::paragraph(words));
  parts.push_back(part.add(html::table_of(table)));
}

Table violations_of(const Film& film) {
  Table table{{{"between", false},
               {"and", false},
               {"from (s)"},
               {"to (s)"},
               {"closest at (s)"},
               {"clearance (m)"},
               {"relative speed (m/s)"},
               {"level", false}},
              {}};
  for (const TooClose& v : film.violations)
    table.rows.push_back({film.bodies[v.a].name, film.bodies[v.b].name, time_text(v.first_us), time_text(v.last_us),
                          time_text(v.closest_us), millimetres_text(v.clearance_um), time_text(v.relative_speed_um_s),
                          v.level});
  return table;
}

// Of the bodies involved, and faults of all.
Table events_of(const Film& film) {
  TimedRows rows;
  const auto add = [&](std::size_t body, std::int64_t at_us, std::string what, std::string details) {
    rows.add(at_us, {film.bodies[body].name, std::move(what), std::move(details)});
  };
  for (const ActivityBar& a : film.activities) {
    if (!is_involved(film, a.body)) continue;
    if (is_near(film, a.begin_us)) add(a.body, a.begin_us, "begins " + a.kind, a.details);
    if (is_near(film, a.end_us)) add(a.body, a.end_us, "ends " + a.kind, "");
  }
  for (const Declared& s : film.states) {
    if (is_involved(film, s.body) && is_near(film, s.at_us)) add(s.body, s.at_us, "its agent says", s.word);
  }
  for (const Happening& h : film.happenings) {
    if (is_near(film, h.at_us) && !h.is_note && (h.is_fault || is_involved(film, h.body)))
      add(h.body, h.at_us, h.what, h.details);
  }
  for (const TooClose& v : film.violations) {
    if (is_near(film, v.first_us)) add(v.a, v.first_us, "too close", "to " + film.bodies[v.b].name);
  }
  return {{{"at (s)"}, {"body", false}, {"event", false}, {"details", false}},
          rows.nearest(film.focus_us, kMostEvents)};
}

const char* word_of(Fate fate) {
  constexpr const char* kWords[] = {"received", "lost by chance", "lost in an outage", "lost by interference",
                                    "lost to a source"};
  return kWords[static_cast<std::size_t>(fate)];
}

// Between the bodies involved.
Table messages_of(const Film& film) {
  TimedRows rows;
  for (const Message& m : film.messages) {
    if (!is_involved(film, m.sender) || !is_near(film, m.sent_us)) continue;
    for (const Arrival& arrival : m.arrivals) {
      if (!is_involved(film, arrival.receiver)) continue;
      const bool received = arrival.fate == Fate::Received;
      rows.add(m.sent_us,
               {fmt::format("#{} {}", m.number, m.kind), film.bodies[m.sender].name, film.bodies[arrival.receiver].name,
                word_of(arrival.fate), received ? time_text(m.sent_us + arrival.after_us) : "",
                received ? time_text(arrival.after_us) : ""});
    }
  }
  return {{{"sent (s)"},
           {"message", false},
           {"from", false},
           {"to", false},
           {"fate", false},
           {"received (s)"},
           {"age then (s)"}},
          rows.nearest(film.focus_us, kMostMessages)};
}

// What holds at the instant of the failure: the last declaration until then.
Table waits_of(const Film& film) {
  std::map<std::size_t, Waiting> last;
  std::map<std::size_t, std::string> state;
  const std::int64_t at_us = film.violations.empty() ? film.end_us : film.focus_us;
  for (const Waiting& w : film.waits) {
    if (w.at_us <= at_us) last[w.body] = w;
  }
  for (const Declared& s : film.states) {
    if (s.at_us <= at_us) state[s.body] = s.word;
  }
  Table table{{{"AGV", false}, {"says it waits for", false}, {"since (s)"}, {"its agent says", false}}, {}};
  for (const auto& [body, wait] : last) {
    if (wait.for_whom)
      table.rows.push_back(
          {film.bodies[body].name, film.bodies[*wait.for_whom].name, time_text(wait.at_us), state[body]});
  }
  return table;
}

Table faults_of(const Film& film) {
  Table table{{{"at (s)"}, {"body", false}, {"event", false}, {"fault", false}}, {}};
  for (const Happening& h : film.happenings) {
    if (h.is_fault) table.rows.push_back({time_text(h.at_us), film.bodies[h.body].name, h.what, h.details});
  }
  return table;
}

Table orders_of(const Film& film) {
  Table table{{{"transport"}, {"AGV", false}, {"from", false}, {"to", false}, {"released (s)"}, {"done (s)"}}, {}};
  for (const Order& o : film.orders)
    table.rows.push_back({fmt::format("{}", o.number), film.bodies[o.body].name, o.from, o.to, time_text(o.released_us),
                          o.done_us ? time_text(*o.done_us) : "open"});
  return table;
}

}  // namespace

std::vector<Element> table_parts(const Film& film) {
  std::vector<Element> parts;
  add_part(parts, "Violations", "", violations_of(film));
  add_part(parts, "Who waits for whom",
           film.violations.empty() ? "At the end of the run." : "At the instant of the first violation.",
           waits_of(film));
  add_part(parts, "Events around the failure", "Of the bodies involved, and all faults.", events_of(film));
  add_part(parts, "Messages around the failure", "Between the bodies involved.", messages_of(film));
  add_part(parts, "Faults", "What the scenario did to the fleet.", faults_of(film));
  add_part(parts, "Transports (orders)", "", orders_of(film));
  return parts;
}

}  // namespace fleetproof::web
