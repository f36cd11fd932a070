#include "reports/replay_page/film_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "reports/markup/section_tables.hpp"
#include "reports/replay_page/film_words.hpp"

namespace fleetproof::web {
namespace {

using html::Element;

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
                          time_text(v.closest_us), metres_text(v.clearance_um), time_text(v.relative_speed_um_s),
                          v.level});
  return table;
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
  add_part(parts, "Faults", "What the scenario did to the fleet.", faults_of(film));
  add_part(parts, "Transports (orders)", "", orders_of(film));
  return parts;
}

}  // namespace fleetproof::web
