#include "campaign/watch/film_story.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "campaign/watch/film_evidence.hpp"
#include "campaign/watch/film_floor.hpp"
#include "campaign/watch/film_shapes.hpp"
#include "campaign/watch/run_text.hpp"
#include "core/base/outside_text.hpp"
#include "core/base/shown_time.hpp"
#include "core/outcome/run_failures.hpp"
#include "reports/page/wording.hpp"

namespace fleetproof {
namespace {

constexpr std::int64_t kBeforeViolation_us = 3'000'000;
constexpr std::size_t kMostInvolved = 8;

// Cut, not rounded: no digit differs from the full number.
double millimetres(std::int64_t um) { return static_cast<double>(um - um % 1000) / 1e6; }
double in_milliseconds(std::int64_t us) { return static_cast<double>(us / 1000) / 1e3; }
double in_milliseconds(SimTime t) { return shown_seconds(t); }

// Tells one story, into one film.
class Storyteller {
 public:
  Storyteller(web::Film& film, const Scenario& scenario, const PiecesOfBodies& bodies, const Outcome& outcome)
      : film_(film), scenario_(scenario), bodies_(bodies), outcome_(outcome), evidence_(film, scenario, bodies) {}

  void tell() {
    film_.failed = outcome_.outcome_class() != OutcomeClass::Clean;
    if (!outcome_.violations.empty()) return tell_violation(outcome_.violations.front());
    tell_without_violation();
    if (film_.nearest) add(nearest_text(*film_.nearest));
  }

 private:
  void tell_without_violation() {
    if (const web::Happening* end = crash()) return tell_crash(*end);
    if (const Incident* incident = longest_stall()) return tell_stall(*incident);
    for (const Incident& incident : outcome_.incidents) {
      if (accuses(incident.kind) && film_.failed) return tell_stall(incident);
    }
    tell_end();
  }

  std::string nearest_text(const web::Nearest& nearest) const {
    return fmt::format("The two that came closest: {} and {}, {:.3f} m at {:.3f} s.", name(EntityId{nearest.a}),
                       name(EntityId{nearest.b}), millimetres(nearest.clearance_um),
                       static_cast<double>(nearest.at_us / 1000) / 1e3);
  }
  std::string name(EntityId id) const { return printable(body_name(scenario_, id)); }
  // Of some bodies there is nothing to say.
  void add(std::string sentence) {
    if (!sentence.empty()) film_.story.push_back(std::move(sentence));
  }
  void look_at(SimTime focus, std::int64_t before_us) {
    film_.focus_us = film_us(focus);
    film_.open_us = std::max<std::int64_t>(0, film_.focus_us - before_us);
  }

  void tell_violation(const Violation& v) {
    look_at(v.first, kBeforeViolation_us);
    film_.involved = {v.a.index(), v.b.index()};
    const char* what = v.contact ? "Contact" : "Safety distance broken";
    film_.title = fmt::format("{}: {} and {} at {:.3f} s", what, name(v.a), name(v.b), in_milliseconds(v.first));
    const std::string limit = distance_text(scenario_.law.safety_distance_m);
    const double speed_mps = millimetres(v.relative_speed_um_s);
    const std::string where =
        "near " + place_text({static_cast<double>(v.x_um) / 1e6, static_cast<double>(v.y_um) / 1e6});
    if (v.contact) {
      add(
          fmt::format("{} and {} come closer than {} at {:.3f} s and touch, {}, with {:.2f} m/s between their closest "
                      "points ({}).",
                      name(v.a), name(v.b), limit, in_milliseconds(v.first), where, speed_mps, name_of(level_of(v))));
    } else {
      add(
          fmt::format("{} and {} are closer than {} from {:.3f} s to {:.3f} s: {:.3f} m at {:.3f} s, {}, with {:.2f} "
                      "m/s between their closest points.",
                      name(v.a), name(v.b), limit, in_milliseconds(v.first), in_milliseconds(v.last),
                      millimetres(v.min_clearance_um), in_milliseconds(v.closest_at), where, speed_mps));
    }
    const web::Happening* end = crash();
    if (end != nullptr && end->at_us <= film_us(v.first)) add(crash_text(*end));
    for (const auto& [one, other] : {std::pair(v.a, v.b), std::pair(v.b, v.a)}) {
      std::string told = evidence_.doing(one, v.first);
      for (const std::string& sentence : evidence_.belief(one, other, v.first)) told += " " + sentence;
      add(std::move(told));
    }
    for (std::string& sentence : evidence_.messages(v.a, v.b, v.first)) add(std::move(sentence));
    add(evidence_.faults(film_.involved, v.first));
    // Of the motions as they were: why they met, this does not say.
    const SimTime over = at_ns(static_cast<std::int64_t>(outcome_.simulated_ns));
    for (std::string& sentence : shape_sentences(scenario_, bodies_, v, over)) add(std::move(sentence));
    tell_more_violations();
  }

  void tell_more_violations() {
    const std::size_t more = outcome_.violations.size() - 1;
    if (more == 0) return;
    const Violation& next = outcome_.violations[1];
    add(fmt::format("{} after it, the next between {} and {} at {:.3f} s. They may follow from the first.",
                    count_text(more, "more violation"), name(next.a), name(next.b), in_milliseconds(next.first)));
  }

  const web::Happening* crash() const {
    if (!outcome_.crash && !outcome_.hang) return nullptr;
    const auto found = std::ranges::find_if(film_.happenings, [](const web::Happening& h) {
      return h.what == name_of(TraceKind::AgentCrashed) || h.what == name_of(TraceKind::AgentHung);
    });
    return found == film_.happenings.end() ? nullptr : &*found;
  }
  std::string crash_text(const web::Happening& end) const {
    const bool hung = end.what == name_of(TraceKind::AgentHung);
    return fmt::format("The agent of {} {} at {:.3f} s{}{}.", name(EntityId{end.body}),
                       hung ? "did not return from a call" : "crashed", in_milliseconds(end.at_us),
                       outcome_.message.empty() ? "" : ": ", printable(outcome_.message, 300));
  }
  void tell_crash(const web::Happening& end) {
    film_.focus_us = end.at_us;
    film_.open_us = std::max<std::int64_t>(0, end.at_us - kBeforeViolation_us);
    film_.involved = {end.body};
    const EntityId agv{end.body};
    film_.title = fmt::format("{} of the agent of {} at {:.3f} s", outcome_.crash ? "Crash" : "Hang", name(agv),
                              in_milliseconds(end.at_us));
    add(crash_text(end));
    const SimTime at = at_ns(end.at_us * 1000);
    add(evidence_.doing(agv, at));
    add(evidence_.faults(film_.involved, at - std::chrono::microseconds(1)));  // the crash itself stands above
  }

  // Of the heaviest end point, the one that was there longest, the first of equals. Null: the fleet did not stall.
  const Incident* longest_stall() const {
    const auto rank = [](const Incident& incident) {
      const auto& end_point = info_of(incident.kind).end_point;
      return std::pair(end_point ? info_of(*end_point).stall_weight : 0, incident.last - incident.first);
    };
    const Incident* found = nullptr;
    for (const Incident& incident : outcome_.incidents) {
      if (rank(incident).first == 0) continue;
      if (found == nullptr || rank(incident) > rank(*found)) found = &incident;
    }
    return found;
  }

  void tell_stall(const Incident& incident) {
    look_at(incident.first, 0);
    std::vector<const Incident*> waits;
    for (const Incident& wait : outcome_.incidents) {
      const bool is_of_it = incident.kind == IncidentKind::Deadlock && is_link(wait.kind) &&
                            wait.first == incident.first && wait.last == incident.last;
      if (is_of_it) waits.push_back(&wait);
    }
    open_when_all_wait(waits);
    const SimTime closed = at_ns(film_.open_us * 1000);
    const std::size_t left_out = involve_all(incident, waits, film_.open_us);
    const IncidentKindInfo& info = info_of(incident.kind);
    std::string word(info.name);
    word.front() = static_cast<char>(word.front() - 'a' + 'A');
    std::string whom;
    for (const std::size_t body : film_.involved) {
      const EntityId id{body};
      const bool is_accused = incident.kind == IncidentKind::Deadlock || id == incident.a || id == incident.b;
      if (is_accused) whom += (whom.empty() ? "" : ", ") + name(id);
    }
    if (left_out > 0 && incident.kind == IncidentKind::Deadlock) whom += fmt::format(" and {} more", left_out);
    film_.title =
        fmt::format("{}{}{} from {:.3f} s on", word, whom.empty() ? "" : ": ", whom, in_milliseconds(incident.first));
    add(fmt::format("From {:.3f} s to {:.3f} s: {}.", in_milliseconds(incident.first), in_milliseconds(incident.last),
                    info.meaning));
    for (const Incident* wait : waits) {
      if (wait->kind == IncidentKind::WaitsInferred)
        add(fmt::format("{} waits for {}, which stands in its way (its agent declares nothing).", name(wait->a),
                        name(wait->b)));
    }
    if (film_.open_us != film_.focus_us)
      add(fmt::format("At {:.3f} s, when the last of these waits was declared:", in_milliseconds(film_.open_us)));
    for (const std::size_t body : film_.involved) {
      std::string told = evidence_.doing(EntityId{body}, closed);
      for (const std::string& sentence : evidence_.from_computers(EntityId{body}, closed)) told += " " + sentence;
      add(std::move(told));
    }
    tell_waiting_fleet(closed);
    add(evidence_.faults(film_.involved, incident.first));
    std::set<std::string> others;
    for (const Incident& other : outcome_.incidents) {
      const IncidentKindInfo& its = info_of(other.kind);
      if (its.role == IncidentRole::Accusation && other.kind != incident.kind) others.insert(std::string(its.name));
    }
    if (!others.empty()) add("The run was also filed for: " + joined({others.begin(), others.end()}) + ".");
  }

  // Who waits for whom then, as the agents say.
  std::map<std::size_t, std::size_t> waiting(std::int64_t at_us) const {
    std::map<std::size_t, std::size_t> whom;
    for (const web::Waiting& w : film_.waits) {
      if (w.at_us > at_us) continue;
      whom.erase(w.body);
      if (w.for_whom) whom[w.body] = *w.for_whom;
    }
    return whom;
  }

  // The bodies of the stall, those for whom they wait, and so on. Where no circle is known, the fleet stands: all its
  // AGVs are involved, those that wait first. Returns how many do not fit.
  std::size_t involve_all(const Incident& incident, const std::vector<const Incident*>& waits, std::int64_t at_us) {
    std::vector<std::size_t> all;
    const auto involve = [&](EntityId id) {
      if (id.valid() && std::ranges::find(all, id.index()) == all.end()) all.push_back(id.index());
    };
    involve(incident.a);
    involve(incident.b);
    for (const Incident* wait : waits) {
      involve(wait->a);
      involve(wait->b);
    }
    const auto whom = waiting(at_us);
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (const auto wait = whom.find(all[i]); wait != whom.end()) involve(EntityId{wait->second});
    }
    const bool is_circle =
        std::ranges::any_of(waits, [&](const Incident* wait) { return wait->a == incident.a; }) || incident.b.valid();
    if (incident.kind == IncidentKind::Deadlock && !is_circle) {
      for (const auto& [one, other] : whom) involve(EntityId{one});
      for (std::size_t agv = 0; agv < scenario_.agvs.size(); ++agv) involve(EntityId{agv});
    }
    std::erase_if(all, [&](std::size_t body) { return scenario_.is_computer(EntityId{body}); });
    const std::size_t left_out = all.size() > kMostInvolved ? all.size() - kMostInvolved : 0;
    all.resize(all.size() - left_out);
    film_.involved = std::move(all);
    return left_out;
  }

  // A deadlock is known from when it began, often before its AGVs say for whom they wait: the page opens when they do,
  // so that the circle shows.
  void open_when_all_wait(const std::vector<const Incident*>& waits) {
    std::map<std::size_t, std::optional<std::size_t>> now;
    const auto holds = [&](const Incident* wait) {
      const auto found = now.find(wait->a.index());
      return wait->kind == IncidentKind::WaitsInferred ||
             (found != now.end() && found->second == std::optional(wait->b.index()));
    };
    for (std::size_t i = 0; i < film_.waits.size(); ++i) {
      const web::Waiting& w = film_.waits[i];
      now[w.body] = w.for_whom;
      const bool is_last_before = i + 1 == film_.waits.size() || film_.waits[i + 1].at_us > film_.focus_us;
      if ((w.at_us < film_.focus_us && !is_last_before) || !std::ranges::all_of(waits, holds)) continue;
      if (!waits.empty()) film_.open_us = std::max(film_.focus_us, w.at_us);
      return;
    }
  }

  void tell_waiting_fleet(SimTime at) {
    const auto whom = waiting(film_us(at));
    const auto waiting_agvs =
        std::ranges::count_if(whom, [&](const auto& entry) { return scenario_.is_agv(EntityId{entry.first}); });
    if (waiting_agvs > 0)
      add(fmt::format("At {:.3f} s, {} of {} AGVs declared that they waited for another{}.", in_milliseconds(at),
                      waiting_agvs, scenario_.agvs.size(), scenario_.computers.empty() ? "" : " or for a computer"));
  }

  void tell_end() {
    const std::int64_t nearest_us = film_.nearest ? film_.nearest->at_us : 0;
    look_at(at_ns(film_.failed ? static_cast<std::int64_t>(outcome_.simulated_ns) : nearest_us * 1000),
            kBeforeViolation_us);
    film_.title = fmt::format("{}: {}", printable(scenario_.name), end_of_run(outcome_));
    add(film_.failed ? fmt::format("The run ended at {:.3f} s: {}.",
                                   in_milliseconds(at_ns(static_cast<std::int64_t>(outcome_.simulated_ns))),
                                   name_of(outcome_.outcome_class()))
                     : "No violation of the safety distance was filed, and the run came to its end.");
    if (!outcome_.message.empty()) add(printable(outcome_.message, 300));
  }

  web::Film& film_;
  const Scenario& scenario_;
  const PiecesOfBodies& bodies_;
  const Outcome& outcome_;
  FilmEvidence evidence_;
};

}  // namespace

void tell_story(web::Film& film, const Scenario& scenario, const PiecesOfBodies& bodies, const Outcome& outcome) {
  Storyteller(film, scenario, bodies, outcome).tell();
}

}  // namespace fleetproof
