#include "campaign/watch/film_evidence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "campaign/watch/film_floor.hpp"
#include "campaign/watch/run_text.hpp"
#include "core/base/outside_text.hpp"
#include "core/outcome/trace.hpp"
#include "reports/page/wording.hpp"
#include "reports/replay_page/film_words.hpp"

namespace fleetproof {
namespace {

constexpr std::int64_t kFaultsBefore_us = 120'000'000;
constexpr std::size_t kMostFaults = 4;
constexpr double kSameStation_m = 5e-3;  // as places are shown

// Cut to milliseconds, as everywhere on the page.
double in_seconds(std::int64_t us) { return static_cast<double>(us / 1000) / 1e3; }
double in_metres(std::int64_t um) { return static_cast<double>(um) / 1e6; }

// The last row of `body` at or before an instant; null if there is none.
template <class Row>
const Row* last_until(const std::vector<Row>& rows, std::size_t body, std::int64_t at_us) {
  const Row* found = nullptr;
  for (const Row& row : rows) {
    if (row.body == body && row.at_us <= at_us) found = &row;
  }
  return found;
}

// The faults that have struck a body and are not over: "breakdown since 29.300 s, not over". Empty: none.
std::string faults_under_way(const web::Film& film, std::size_t body, std::int64_t before_us) {
  std::map<std::string, std::int64_t> since_us;
  for (const web::Happening& h : film.happenings) {
    if (!h.is_fault || h.body != body || h.at_us >= before_us) continue;
    const std::string& fault = h.details.empty() ? h.what : h.details;
    if (h.what.ends_with(" over")) {
      since_us.erase(fault);
    } else {
      since_us.emplace(fault, h.at_us);
    }
  }
  std::vector<std::string> texts;
  for (const auto& [fault, at_us] : since_us)
    texts.push_back(fmt::format("{} since {:.3f} s", fault, in_seconds(at_us)));
  return texts.empty() ? "" : joined(texts) + ", not over";
}

// Since when the body has stood at the place of the first violation. Nothing if it moved there, or is not one of its
// two bodies.
std::optional<std::int64_t> stood_there_since(const web::Film& film, std::size_t body, std::int64_t at_us) {
  if (film.violations.empty()) return std::nullopt;
  const web::TooClose& first = film.violations.front();
  if (body != first.a && body != first.b) return std::nullopt;
  std::int64_t since_us = 0;
  for (const web::MotionPiece& piece : film.pieces) {
    const bool moves = piece.body == body && piece.moving != web::Moving::Rests && piece.begin_us < first.first_us;
    if (moves) since_us = std::max(since_us, piece.end_us);
  }
  return since_us < at_us ? std::optional(since_us) : std::nullopt;
}

}  // namespace

std::string given_deliveries_text(std::span<const GivenDelivery> deliveries) {
  if (deliveries.empty()) return {};
  const auto count = [&](auto is_meant) {
    return static_cast<std::size_t>(std::ranges::count_if(deliveries, is_meant));
  };
  const std::size_t lost = count([](const GivenDelivery& f) { return f.lost; });
  const std::size_t doubled = count([](const GivenDelivery& f) { return !f.lost && f.copied; });
  std::vector<std::string> kinds;
  if (lost > 0) kinds.push_back(fmt::format("{} lost", lost));
  if (doubled > 0) kinds.push_back(fmt::format("{} delivered twice", doubled));
  if (deliveries.size() > lost + doubled)
    kinds.push_back(fmt::format("{} with a given delay", deliveries.size() - lost - doubled));
  return fmt::format("{} ({})", count_text(deliveries.size(), "message"), joined(kinds));
}

std::string place_text(const Vec2& place_m) {
  const auto shown = [](double at_m) { return std::round(at_m * 100.0) == 0.0 ? 0.0 : at_m; };
  return fmt::format("({:.2f}, {:.2f}) m", shown(place_m.x()), shown(place_m.y()));
}

std::string FilmEvidence::name(EntityId id) const { return printable(body_name(scenario_, id)); }

// "A4.2, (26.10, 9.20) m" at a station.
std::string FilmEvidence::named_place(const Vec2& place_m) const {
  for (const Station& station : scenario_.map->layout().stations) {
    if ((station.position_m - place_m).norm() < kSameStation_m)
      return printable(station.name) + ", " + place_text(place_m);
  }
  return place_text(place_m);
}

std::string FilmEvidence::doing(EntityId body, SimTime at) const {
  if (scenario_.is_computer(body)) return {};
  const Piece* piece = piece_at(bodies_, body, at);
  if (piece == nullptr) return name(body) + " was not on the floor.";
  if (!is_agv(body)) return name(body) + " lay on the floor.";
  const std::int64_t at_us = film_us(at);
  const web::ActivityBar* activity = nullptr;
  for (const web::ActivityBar& bar : film_.activities) {
    if (bar.body == body.index() && bar.begin_us <= at_us && at_us <= bar.end_us) activity = &bar;
  }
  const Pose pose = piece->pose_at(at);
  std::string text = fmt::format("{} ", name(body));
  if (piece->manner == Manner::Drive) {
    text += fmt::format("was driving from {} at {:.2f} m/s", activity == nullptr ? "" : activity->details,
                        piece->speed_at(at));
  } else if (piece->manner == Manner::Turn) {
    text += "was turning on the spot at " + named_place(pose.position_m);
  } else {
    text += "stood at " + named_place(pose.position_m);
    if (const auto since_us = stood_there_since(film_, body.index(), at_us))
      text += fmt::format(" since {:.3f} s", in_seconds(*since_us));
    if (activity != nullptr)
      text += fmt::format(", in the middle of its {}{}", activity->kind,
                          activity->details.empty() ? "" : " " + activity->details);
  }
  if (const std::string faults = faults_under_way(film_, body.index(), at_us); !faults.empty()) text += "; " + faults;
  if (const web::Declared* state = last_until(film_.states, body.index(), at_us);
      state != nullptr && !state->word.empty())
    text += fmt::format("; its agent said \"{}\" since {:.3f} s", state->word, in_seconds(state->at_us));
  if (const web::Waiting* wait = last_until(film_.waits, body.index(), at_us); wait != nullptr && wait->for_whom)
    text += fmt::format(" and that it waited for {} (since {:.3f} s)", name(EntityId{*wait->for_whom}),
                        in_seconds(wait->at_us));
  return text + ".";
}

std::vector<std::string> FilmEvidence::belief(EntityId agv, EntityId other, SimTime at) const {
  if (!is_agv(agv) || !is_agv(other)) return {};
  const web::Belief* last = nullptr;
  bool any = false;
  const std::int64_t at_us = film_us(at);
  for (const web::Belief& b : film_.beliefs) {
    any = any || b.body == agv.index();
    if (b.body == agv.index() && b.about == other.index() && b.at_us <= at_us) last = &b;
  }
  if (!any) return {};
  if (last == nullptr)
    return {fmt::format("The agent of {} had no belief about where {} was.", name(agv), name(other))};
  const Vec2 believed(in_metres(last->x_um), in_metres(last->y_um));
  std::string text =
      fmt::format("The agent of {} believed {} to be at {}, as of {:.3f} s: {:.1f} s old", name(agv), name(other),
                  place_text(believed), in_seconds(last->as_of_us), in_seconds(at_us - last->as_of_us));
  if (const Piece* piece = piece_at(bodies_, other, at))
    text += fmt::format(", {:.1f} m from where it was", (piece->pose_at(at).position_m - believed).norm());
  return {text + "."};
}

std::vector<std::string> FilmEvidence::messages(EntityId one, EntityId other, SimTime at) const {
  if (!is_agv(one) || !is_agv(other)) return {};
  if (film_.messages.empty()) return {"No AGV sent any message in this run: the agents did not coordinate."};
  const auto sends = [&](EntityId agv) {
    return std::ranges::any_of(
        film_.messages, [&](const web::Message& m) { return m.sender == agv.index() && m.sent_us <= film_us(at); });
  };
  if (!sends(one) && !sends(other))
    return {fmt::format("Until then, neither {} nor {} had sent a message.", name(one), name(other))};
  return {};  // what they sent each other stands in the reasons of the page
}

// What a computer said to it last, and the last that said something else: the grant that it still has, for instance.
std::vector<std::string> FilmEvidence::from_computers(EntityId agv, SimTime at) const {
  std::vector<std::string> told;
  for (std::size_t i = 0; i < scenario_.computers.size(); ++i) {
    const EntityId computer{scenario_.agvs.size() + i};
    const web::Message *last = nullptr, *before = nullptr;
    for (const web::Message& m : film_.messages) {
      const bool is_to_it = m.sender == computer.index() && m.receiver == std::optional(agv.index());
      if (!is_to_it || m.sent_us > film_us(at)) continue;
      if (last != nullptr && (last->kind != m.kind || last->content != m.content)) before = last;
      last = &m;
    }
    if (last == nullptr) {
      told.push_back(fmt::format("{} had sent it nothing.", name(computer)));
      continue;
    }
    const auto text = [&](const web::Message& m) {
      const web::Arrival* arrival = m.arrivals.empty() ? nullptr : &m.arrivals.front();
      std::string fate = arrival == nullptr ? "" : std::string(", ") + web::word_of(arrival->receipt);
      if (arrival != nullptr && arrival->receipt == web::Receipt::Received)
        fate = m.sent_us + arrival->after_us > film_us(at)
                   ? ", under way"
                   : fmt::format(", received {:.3f} s", in_seconds(m.sent_us + arrival->after_us));
      return fmt::format("{}, sent {:.3f} s{}", web::text_of(m), in_seconds(m.sent_us), fate);
    };
    std::string sentence = fmt::format("The last that {} had sent it was {}", name(computer), text(*last));
    if (before != nullptr) sentence += fmt::format("; the last that said something else, {}", text(*before));
    told.push_back(sentence + ".");
  }
  return told;
}

std::string FilmEvidence::faults(const std::vector<std::size_t>& bodies, SimTime at) const {
  const std::int64_t at_us = film_us(at);
  std::vector<std::string> found;
  for (const web::Happening& h : film_.happenings) {
    if (!h.is_fault || h.at_us > at_us || h.at_us < at_us - kFaultsBefore_us) continue;
    // A computer may have decided for any of them.
    if (std::ranges::find(bodies, h.body) == bodies.end() && !film_.is_computer(h.body)) continue;
    if (h.details.empty()) {  // no injected fault
      found.push_back(fmt::format("{}: {} {:.3f} s before ({:.3f} s)", name(EntityId{h.body}), h.what,
                                  in_seconds(at_us - h.at_us), in_seconds(h.at_us)));
      continue;
    }
    const bool is_end = h.what == name_of(TraceKind::FaultOver);
    found.push_back(fmt::format("{}{} of {} {:.3f} s before ({:.3f} s)", is_end ? "end of the " : "", h.details,
                                name(EntityId{h.body}), in_seconds(at_us - h.at_us), in_seconds(h.at_us)));
  }
  const std::string deliveries = given_deliveries_text(scenario_.deliveries);
  const std::string radio = deliveries.empty() ? "" : " The scenario decides the delivery of " + deliveries + ".";
  if (found.empty()) return "No injected fault struck them in the two minutes before." + radio;
  std::ranges::reverse(found);
  const std::size_t more = found.size() > kMostFaults ? found.size() - kMostFaults : 0;
  found.resize(found.size() - more);
  return "Faults before it, the latest first: " + joined(found, "; ") +
         (more > 0 ? fmt::format("; and {} more", more) : "") + "." + radio;
}

}  // namespace fleetproof
