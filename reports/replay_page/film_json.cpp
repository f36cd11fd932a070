#include "reports/replay_page/film_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>

#include "core/base/json_text.hpp"
#include "core/base/outside_text.hpp"

namespace fleetproof::web {
namespace {

std::string in_json(const std::string& text) { return json_text(Json(text)); }

// Cut, as every instant of the page: what is said to have happened at an instant has happened by then.
std::int64_t milliseconds(std::int64_t us) { return us / 1000; }
// Of places and directions: to the nearest thousand.
std::int64_t thousandth(std::int64_t value) { return (value >= 0 ? value + 500 : value - 500) / 1000; }

// Texts that occur often, each once.
class Words {
 public:
  std::size_t index_of(const std::string& word) {
    const auto [at, fresh] = indices_.emplace(word, words_.size());
    if (fresh) words_.push_back(word);
    return at->second;
  }
  const std::vector<std::string>& all() const { return words_; }

 private:
  std::map<std::string, std::size_t> indices_;
  std::vector<std::string> words_;
};

// Writes members one after the other. Rows are arrays of whole numbers.
class Members {
 public:
  void add(const char* name, const std::string& json) {
    text_ += fmt::format("{}\"{}\":{}", text_.empty() ? "{" : ",\n", name, json);
  }
  template <class Items, class RowOf>
  void rows(const char* name, const Items& items, RowOf row_of) {
    std::string all = "[";
    for (const auto& item : items) {
      if (all.size() > 1) all += ',';
      all += row_of(item);
    }
    add(name, all + "]");
  }
  std::string text() const { return text_ + "}"; }

 private:
  std::string text_;
};

template <class... Numbers>
std::string row(Numbers... numbers) {
  std::string text = "[";
  ((text += fmt::format("{},", numbers)), ...);
  text.back() = ']';
  return text;
}

std::int64_t or_none(const std::optional<std::size_t>& body) { return body ? static_cast<std::int64_t>(*body) : -1; }

std::string track_json(const Track& track) {
  std::string points = "[";
  for (const TrackPoint& p : track.points)
    points += fmt::format("{}{},{},{},{}", points.size() > 1 ? "," : "", p.x_um, p.y_um, p.heading_urad, p.way_um);
  return fmt::format("{{\"name\":{},\"points_um_urad\":{}]}}", in_json(track.name), points);
}

std::string piece_json(const MotionPiece& p) {
  std::string text =
      fmt::format("[{},{},{},{},{}", p.body, static_cast<int>(p.moving), p.begin_us, p.end_us, p.outline);
  if (p.moving == Moving::Drives) {
    text += fmt::format(",{},{},{},{}", p.track, (p.against_track ? 1 : 0) + (p.tail_first ? 2 : 0), p.way_begin_um,
                        p.planned_way);
  } else {
    text += fmt::format(",{},{},{},{}", p.x_um, p.y_um, p.heading_urad, p.planned_way);
  }
  for (const Phase& phase : p.phases)
    text += fmt::format(",{},{},{},{}", phase.begin_us, phase.way, phase.speed, phase.acceleration);
  return text + "]";
}

// Of each arrival the receiver, and the age in milliseconds; of a loss minus the number of its kind.
std::string message_json(const Message& message, Words& words) {
  std::string text = fmt::format("[{},{},{},{},{},{}", message.number, message.sender, or_none(message.receiver),
                                 milliseconds(message.sent_us), words.index_of(message.kind), message.bytes);
  for (const Arrival& arrival : message.arrivals) {
    const bool received = arrival.receipt == Receipt::Received;
    text += fmt::format(",{},{}", arrival.receiver,
                        received ? milliseconds(message.sent_us + arrival.after_us) - milliseconds(message.sent_us)
                                 : -static_cast<std::int64_t>(arrival.receipt));
  }
  return text + "]";
}

std::string belief_json(const Belief& b) {
  std::string text = fmt::format("[{},{},{},{},{},{}", b.body, b.about, milliseconds(b.at_us), milliseconds(b.as_of_us),
                                 thousandth(b.x_um), thousandth(b.y_um));
  return text + (b.heading_urad ? fmt::format(",{}]", thousandth(*b.heading_urad)) : "]");
}

void add_floor(Members& members, const Film& film) {
  members.add("safety_distance_um", fmt::format("{}", film.safety_distance_um));
  members.add("floor_um", row(film.floor_low_x_um, film.floor_low_y_um, film.floor_high_x_um, film.floor_high_y_um));
  members.rows("tracks", film.tracks, track_json);
  members.rows("stations", film.stations, [](const FilmStation& s) {
    return fmt::format("{{\"name\":{},\"x_um\":{},\"y_um\":{}}}", in_json(s.name), s.x_um, s.y_um);
  });
  constexpr std::array kKinds{"AGV", "obstacle", "load", "computer"};  // of BodyKind
  members.rows("bodies", film.bodies, [&](const Body& body) {
    const std::string antenna =
        body.antenna ? fmt::format(",\"x_um\":{},\"y_um\":{}", body.antenna->x_um, body.antenna->y_um) : "";
    return fmt::format("{{\"name\":{},\"kind\":\"{}\"{}}}", in_json(body.name),
                       kKinds.at(static_cast<std::size_t>(body.kind)), antenna);
  });
  members.rows("outlines_um", film.outlines,
               [](const Outline& o) { return row(o.length_um, o.width_um, o.centre_ahead_um); });
  members.rows("pieces_us_um_urad", film.pieces, piece_json);
}

void add_failure(Members& members, const Film& film) {
  members.rows("violations", film.violations, [](const TooClose& v) {
    const Json json = {{"a", v.a},
                       {"b", v.b},
                       {"first_us", v.first_us},
                       {"last_us", v.last_us},
                       {"closest_us", v.closest_us},
                       {"clearance_um", v.clearance_um},
                       {"relative_speed_um_s", v.relative_speed_um_s},
                       {"contact", v.contact},
                       {"level", v.level}};
    return json_text(json);
  });
  members.add("nearest", film.nearest
                             ? fmt::format(R"({{"a":{},"b":{},"at_us":{},"clearance_um":{}}})", film.nearest->a,
                                           film.nearest->b, film.nearest->at_us, film.nearest->clearance_um)
                             : "null");
  members.rows("clearances", film.clearances, [](const ClearanceCurve& curve) {
    std::string points;
    for (const auto& [at_us, clearance_um] : curve.points)
      points += fmt::format("{}{},{}", points.empty() ? "" : ",", at_us, clearance_um);
    return fmt::format("{{\"a\":{},\"b\":{},\"points_us_um\":[{}]}}", curve.a, curve.b, points);
  });
}

std::string kept_json(const Film& film, const Kept& kept) {
  const auto until = [&](std::int64_t to_us) { return milliseconds(std::min(to_us, film.end_us)); };
  return row(milliseconds(kept.involved_from_us), until(kept.involved_to_us), milliseconds(kept.others_from_us),
             until(kept.others_to_us));
}

// What messages of the bodies involved and of computers say, by their numbers: a fleet says too much for all of it.
void add_contents(Members& members, const Film& film, Words& words) {
  const std::vector<std::size_t> subject = film.subject();
  const auto counts = [&](std::size_t body) {
    return film.is_computer(body) || std::ranges::find(subject, body) != subject.end();
  };
  std::vector<const Message*> told;
  for (const Message& m : film.messages) {
    if (!m.content.empty() && (counts(m.sender) || (m.receiver && counts(*m.receiver)))) told.push_back(&m);
  }
  members.rows("contents", told, [&](const Message* m) { return row(m->number, words.index_of(m->content)); });
}

void add_what_happened(Members& members, const Film& film, Words& words) {
  members.add("kept_ms", fmt::format("{{\"messages\":{},\"beliefs\":{},\"states\":{},\"waits\":{}}}",
                                     kept_json(film, film.kept_messages), kept_json(film, film.kept_beliefs),
                                     kept_json(film, film.kept_states), kept_json(film, film.kept_waits)));
  members.rows("activities_ms", film.activities, [&](const ActivityBar& a) {
    return row(a.body, milliseconds(a.begin_us), milliseconds(a.end_us), words.index_of(a.kind),
               words.index_of(a.details));
  });
  members.rows("states_ms", film.states,
               [&](const Declared& s) { return row(s.body, milliseconds(s.at_us), words.index_of(s.word)); });
  members.rows("waits_ms", film.waits,
               [](const Waiting& w) { return row(w.body, milliseconds(w.at_us), or_none(w.for_whom)); });
  members.rows("loads_ms", film.loads,
               [](const Loaded& l) { return row(l.body, milliseconds(l.at_us), l.on ? 1 : 0); });
  members.rows("messages_ms", film.messages, [&](const Message& m) { return message_json(m, words); });
  add_contents(members, film, words);
  members.rows("beliefs_ms_mm_mrad", film.beliefs, belief_json);
  members.rows("happenings_ms", film.happenings, [&](const Happening& h) {
    return row(h.body, milliseconds(h.at_us), words.index_of(h.what), words.index_of(h.details),
               (h.is_fault ? 1 : 0) + (h.is_note ? 2 : 0));
  });
}

// Outside of strings, JSON has none of these characters.
std::string without_markup(const std::string& json) {
  std::string text;
  text.reserve(json.size());
  for (const char c : json) {
    if (c == '<' || c == '>' || c == '&') {
      text += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      text += c;
    }
  }
  return text;
}

}  // namespace

std::string film_json(const Film& film) {
  Members members;
  Words words;
  members.add("schema_version", "1");
  members.add("title", in_json(film.title));
  for (const auto& [name, value] : std::initializer_list<std::pair<const char*, std::int64_t>>{
           {"end_us", film.end_us}, {"focus_us", film.focus_us}, {"open_us", film.open_us}})
    members.add(name, fmt::format("{}", value));
  members.rows("involved", film.involved, [](std::size_t body) { return fmt::format("{}", body); });
  add_floor(members, film);
  add_failure(members, film);
  add_what_happened(members, film, words);
  members.rows("words", words.all(), in_json);
  return without_markup(printable_json(members.text()));
}

}  // namespace fleetproof::web
