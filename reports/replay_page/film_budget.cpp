#include "reports/replay_page/film_budget.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace fleetproof::web {
namespace {

constexpr std::int64_t kBudgetAfterCounts = 3, kBudgetOthersCount = 8;

// How far from the failure something is: microseconds, more of them after it and for bodies that are not involved.
class Distance {
 public:
  explicit Distance(const Film& film) : focus_us_(film.focus_us), involved_(film.bodies.size(), false) {
    for (const std::size_t body : film.involved) involved_[body] = true;
  }
  bool is_involved(std::size_t body) const { return involved_[body]; }
  std::int64_t of(std::int64_t at_us, bool involved) const {
    const std::int64_t away_us = at_us < focus_us_ ? focus_us_ - at_us : kBudgetAfterCounts * (at_us - focus_us_);
    return away_us * (involved ? 1 : kBudgetOthersCount);
  }

 private:
  std::int64_t focus_us_;
  std::vector<bool> involved_;
};

struct Candidate {
  std::int64_t distance = 0;
  std::size_t bytes = 0;
};

// The largest distance that fits the budget, with all that is nearer.
std::int64_t reach_of(std::vector<Candidate> candidates, std::size_t budget_bytes) {
  std::ranges::stable_sort(candidates, {}, &Candidate::distance);
  std::size_t spent = 0;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    spent += candidates[i].bytes;
    if (spent > budget_bytes) return candidates[i].distance - 1;
  }
  return candidates.empty() ? 0 : candidates.back().distance;
}

std::string span_text(std::int64_t from_us, std::int64_t to_us) {
  return fmt::format("{:.1f} s to {:.1f} s", static_cast<double>(from_us) / 1e6, static_cast<double>(to_us) / 1e6);
}

// Where nothing is left out.
Kept kept_within(const Film& film, std::int64_t reach_us) {
  const auto from_us = [&](std::int64_t reach) { return std::max<std::int64_t>(0, film.focus_us - reach); };
  const auto to_us = [&](std::int64_t reach) {
    return std::min(film.end_us, film.focus_us + reach / kBudgetAfterCounts);
  };
  return {from_us(reach_us), to_us(reach_us), from_us(reach_us / kBudgetOthersCount),
          to_us(reach_us / kBudgetOthersCount)};
}

Kept tell(Film& film, const char* what, std::size_t kept, std::size_t all, std::int64_t reach_us) {
  if (kept == all) return {};
  const Kept whole = kept_within(film, reach_us);
  film.left_out.push_back(fmt::format("This page has {} of {} {}: all from {}, and all of the bodies involved from {}.",
                                      kept, all, what, span_text(whole.others_from_us, whole.others_to_us),
                                      span_text(whole.involved_from_us, whole.involved_to_us)));
  return whole;
}

// Of the items that `is_meant`, those that fit the budget.
template <class Item, class DistanceOf, class BytesOf, class IsMeant>
Kept keep_nearest(Film& film, std::vector<Item>& items, const char* what, std::size_t budget_bytes,
                  DistanceOf distance_of, BytesOf bytes_of, IsMeant is_meant) {
  std::vector<Candidate> candidates;
  for (const Item& item : items) {
    if (is_meant(item)) candidates.push_back({distance_of(item), bytes_of(item)});
  }
  const std::size_t all = candidates.size();
  const std::int64_t reach = reach_of(std::move(candidates), budget_bytes);
  const std::size_t gone =
      std::erase_if(items, [&](const Item& item) { return is_meant(item) && distance_of(item) > reach; });
  return tell(film, what, all - gone, all, reach);
}

// An arrival costs its part of the message, and itself. Of messages of computers the page has the contents, too. A
// message that nobody was in range to receive counts as one.
Kept keep_messages(Film& film, const Distance& distance, std::size_t budget_bytes) {
  constexpr std::size_t kMessage = 34, kArrival = 9;
  const auto distance_of = [&](const Message& message, const Arrival& arrival) {
    return distance.of(message.sent_us, distance.is_involved(message.sender) || distance.is_involved(arrival.receiver));
  };
  const auto bytes_of = [&](const Message& message) {
    const bool is_told = film.is_computer(message.sender) || (message.receiver && film.is_computer(*message.receiver));
    return kMessage + (is_told ? message.content.size() : 0);
  };
  const auto distance_of_unheard = [&](const Message& message) {
    return distance.of(message.sent_us, distance.is_involved(message.sender));
  };
  std::vector<Candidate> candidates;
  std::size_t unheard = 0;
  for (const Message& message : film.messages) {
    if (message.arrivals.empty()) {
      ++unheard;
      candidates.push_back({distance_of_unheard(message), bytes_of(message)});
    }
    for (const Arrival& arrival : message.arrivals)
      candidates.push_back({distance_of(message, arrival), kArrival + bytes_of(message) / message.arrivals.size()});
  }
  const std::size_t all = candidates.size();
  const std::int64_t reach = reach_of(std::move(candidates), budget_bytes);
  std::size_t kept = 0;
  std::vector<Message> stay;
  for (Message& message : film.messages) {
    const bool is_unheard = message.arrivals.empty();
    if (is_unheard && distance_of_unheard(message) > reach) continue;
    std::erase_if(message.arrivals, [&](const Arrival& arrival) { return distance_of(message, arrival) > reach; });
    kept += is_unheard ? 1 : message.arrivals.size();
    if (is_unheard || !message.arrivals.empty()) stay.push_back(std::move(message));
  }
  film.messages = std::move(stay);
  const char* what = unheard > 0 ? "receptions of messages and messages to nobody" : "receptions of messages";
  return tell(film, what, kept, all, reach);
}

}  // namespace

void keep_within(Film& film, const FilmBudget& budget) {
  const Distance distance(film);
  film.kept_messages = keep_messages(film, distance, budget.message_bytes);
  film.kept_beliefs = keep_nearest(
      film, film.beliefs, "beliefs of agents", budget.belief_bytes,
      [&](const Belief& b) { return distance.of(b.at_us, distance.is_involved(b.body)); },
      [](const Belief&) { return std::size_t{34}; }, [](const Belief&) { return true; });
  for (const bool notes : {false, true}) {
    keep_nearest(
        film, film.happenings, notes ? "notes of agents" : "events", budget.happening_bytes / 2,
        [&](const Happening& h) { return h.is_fault ? 0 : distance.of(h.at_us, distance.is_involved(h.body)); },
        [](const Happening& h) { return 16 + h.details.size(); },
        [&](const Happening& h) { return h.is_note == notes; });
  }
  film.kept_states = keep_nearest(
      film, film.states, "words of agents about what they do", budget.state_bytes,
      [&](const Declared& s) { return distance.of(s.at_us, distance.is_involved(s.body)); },
      [](const Declared& s) { return 16 + s.word.size(); }, [](const Declared&) { return true; });
  film.kept_waits = keep_nearest(
      film, film.waits, "declarations of whom an AGV waits for", budget.wait_bytes,
      [&](const Waiting& w) { return distance.of(w.at_us, distance.is_involved(w.body)); },
      [](const Waiting&) { return std::size_t{13}; }, [](const Waiting&) { return true; });
}

}  // namespace fleetproof::web
