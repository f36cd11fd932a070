#include "campaign/watch/replay_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "campaign/watch/film_clearances.hpp"
#include "campaign/watch/film_evidence.hpp"
#include "campaign/watch/film_floor.hpp"
#include "campaign/watch/film_frames.hpp"
#include "campaign/watch/film_story.hpp"
#include "core/agents/vocabulary.hpp"
#include "core/base/outside_text.hpp"
#include "core/outcome/run_failures.hpp"
#include "reports/page/wording.hpp"
#include "reports/replay_page/replay_page.hpp"

namespace fleetproof {
namespace {

bool has_word(std::string_view text, std::string_view word) {
  const auto is_end = [&](std::size_t at) {
    return at >= text.size() || std::isalnum(static_cast<unsigned char>(text[at])) == 0;
  };
  for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1)) {
    if ((at == 0 || is_end(at - 1)) && is_end(at + word.size())) return true;
  }
  return false;
}

// What the words of agents in this run mean, as far as the project's agents use them: notes, states, and words in the
// contents of messages.
void add_glossary(web::Film& film) {
  std::set<std::string> said, contents;
  for (const web::Happening& h : film.happenings) {
    if (h.is_note) said.insert(h.details);
  }
  for (const web::Declared& state : film.states) said.insert(state.word);
  for (const web::Message& message : film.messages) contents.insert(message.content);
  for (const auto& [word, meaning] : agents::vocabulary()) {
    const bool occurs = said.contains(std::string(word)) ||
                        std::ranges::any_of(contents, [&](const std::string& c) { return has_word(c, word); });
    if (occurs) film.glossary.push_back({std::string(word), std::string(meaning)});
  }
}

void add_facts(web::Film& film, const Scenario& scenario, const Outcome& outcome) {
  const auto add = [&](const char* name, std::string value) { film.facts.push_back({name, std::move(value)}); };
  add("scenario", scenario.name);
  add("layout", scenario.map->layout().name);
  add("AGVs", fmt::format("{}", scenario.agvs.size()));
  std::vector<std::string> computers;
  for (const ComputerSetup& computer : scenario.computers) computers.push_back(printable(computer.name));
  if (!computers.empty()) add("computers", joined(computers));
  add("horizon", fmt::format("{:g} s", to_seconds(scenario.horizon)));
  const std::string deliveries = given_deliveries_text(scenario.deliveries);
  add("loss", percent(scenario.radio.loss) + (deliveries.empty() ? "" : ", but of messages with a given delivery"));
  if (!deliveries.empty()) add("given deliveries", deliveries);
  add("delay", fmt::format("{:g} s ({})", scenario.radio.delay_s, name_of(scenario.radio.delay_model)));
  if (scenario.radio.outages.mean_outage_s > 0.0)
    add("outages of", fmt::format("{:g} s", scenario.radio.outages.mean_outage_s));
  add("safety distance", distance_text(scenario.law.safety_distance_m));
  add("seed", fmt::format("{}", scenario.seed));
  add("end point", end_of_run(outcome));
  add("trace digest", hex_text(outcome.digest));
}

void add_violations(web::Film& film, const Outcome& outcome) {
  for (const Violation& v : outcome.violations) {
    web::TooClose close;
    close.a = v.a.index();
    close.b = v.b.index();
    close.first_us = film_us(v.first);
    close.last_us = film_us(v.last);
    close.closest_us = film_us(v.closest_at);
    close.clearance_um = v.min_clearance_um;
    close.relative_speed_um_s = v.relative_speed_um_s;
    close.contact = v.contact;
    close.level = name_of(level_of(v));
    film.violations.push_back(std::move(close));
  }
}

void add_strip(web::Film& film, const Scenario& scenario, const std::vector<Piece>& pieces, const Outcome& outcome) {
  const SimTime end = at_ns(static_cast<std::int64_t>(outcome.simulated_ns));
  StripSubject subject{at_ns(film.focus_us * 1000), {}, {}, false};
  if (film.involved.size() > 1) {
    subject.a = EntityId{film.involved[0]};
    subject.b = EntityId{film.involved[1]};
  }
  if (film.is_about_nearest()) {
    subject = {at_ns(film.nearest->at_us * 1000), EntityId{film.nearest->a}, EntityId{film.nearest->b}, true};
  }
  if (!outcome.violations.empty()) {
    subject.at = outcome.violations.front().closest_at;
    subject.is_quick = true;
    subject.stops_there = outcome.violations.front().contact && scenario.contact_stops;
  }
  std::vector<Still> stills = blank_stills(subject, end);
  StillCamera camera(stills);
  for (const Piece& piece : pieces) camera.piece_ended(piece);
  camera.finish(end);
  film.strip = strip_of(stills, subject, scenario);
}

}  // namespace

web::Film film_of(FilmRecorder& recorder, const Scenario& scenario, const Outcome& outcome, const ReplayWords& words,
                  const std::string& remark) {
  web::Film film = recorder.take(at_ns(static_cast<std::int64_t>(outcome.simulated_ns)));
  film.command = words.command;
  film.facts = words.facts;
  add_facts(film, scenario, outcome);
  add_floor(film, scenario);
  add_motion(film, scenario, recorder.pieces());
  add_violations(film, outcome);
  const PiecesOfBodies bodies = pieces_of_bodies(recorder.pieces());
  add_clearances(film, bodies, outcome);
  tell_story(film, scenario, bodies, outcome);
  if (!remark.empty()) film.story.insert(film.story.begin(), remark);
  add_glossary(film);
  add_strip(film, scenario, recorder.pieces(), outcome);
  return film;
}

std::string replay_html(FilmRecorder& recorder, const Scenario& scenario, const Outcome& outcome,
                        const ReplayWords& words, const std::string& remark) {
  return web::replay_page(film_of(recorder, scenario, outcome, words, remark), words.explained);
}

}  // namespace fleetproof
