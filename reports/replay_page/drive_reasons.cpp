#include "reports/replay_page/drive_reasons.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include "reports/replay_page/drive_reason.hpp"

namespace fleetproof::web {
namespace {

constexpr std::int64_t kOthersCount = 8, kAfterCounts = 3;
constexpr std::size_t kMostBytes = 400'000;  // of a fleet of 50, a reason has four thousand

// The last activity that the body began before the failure.
std::optional<std::size_t> last_before(const Film& film, std::size_t body, std::int64_t at_us) {
  std::optional<std::size_t> last;
  for (std::size_t i = 0; i < film.activities.size(); ++i) {
    const ActivityBar& bar = film.activities[i];
    if (bar.body == body && bar.begin_us <= at_us) last = i;
  }
  return last;
}

std::optional<std::size_t> other_of(const std::vector<std::size_t>& pair, std::size_t body) {
  if (pair.size() != 2) return std::nullopt;
  if (pair[0] == body) return pair[1];
  return pair[1] == body ? std::optional(pair[0]) : std::nullopt;
}

// The activities in the order in which one wants their reasons.
std::vector<std::size_t> nearest_first(const Film& film) {
  const std::vector<std::size_t> subject = film.subject();
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < film.activities.size(); ++i) {
    if (film.bodies[film.activities[i].body].kind == BodyKind::Agv) order.push_back(i);
  }
  std::ranges::stable_sort(order, {}, [&](std::size_t i) {
    const ActivityBar& bar = film.activities[i];
    const std::int64_t before_us = film.focus_us - bar.begin_us;
    const bool is_subject = std::ranges::find(subject, bar.body) != subject.end();
    return (before_us >= 0 ? before_us : -kAfterCounts * before_us) * (is_subject ? 1 : kOthersCount);
  });
  return order;
}

}  // namespace

const ReasonLine* Reason::decisive() const {
  const auto heaviest = std::ranges::max_element(lines, {}, &ReasonLine::weight);
  return heaviest == lines.end() || heaviest->weight < 2 ? nullptr : &*heaviest;
}

std::vector<Reason> drive_reasons(const Film& film, std::size_t most) {
  std::vector<std::size_t> fatal, idle, rest = nearest_first(film);
  if (!film.violations.empty()) {
    for (const std::size_t body : {film.violations.front().a, film.violations.front().b}) {
      if (const auto last = last_before(film, body, film.violations.front().first_us)) {
        fatal.push_back(*last);
      } else if (film.bodies[body].kind == BodyKind::Agv) {
        idle.push_back(body);
      }
    }
  }
  std::erase_if(rest, [&](std::size_t i) { return std::ranges::find(fatal, i) != fatal.end(); });
  rest.resize(std::min(rest.size(), most > fatal.size() ? most - fatal.size() : 0));
  const FilmTalk talk(film);
  const std::vector<std::size_t> subject = film.subject();
  std::vector<Reason> reasons;
  std::size_t bytes = 0;
  for (const auto* activities : {&fatal, &rest}) {
    for (const std::size_t i : *activities) {
      Reason reason = reason_of(film, talk, i, other_of(subject, film.activities[i].body));
      reason.is_fatal = activities == &fatal;
      for (const ReasonLine& line : reason.lines) bytes += line.text.size();
      if (bytes > kMostBytes && !reason.is_fatal) break;
      reasons.push_back(std::move(reason));
    }
  }
  std::ranges::sort(reasons.begin() + std::ssize(fatal), reasons.end(), {}, &Reason::activity);
  // What says most of why stands first. Of equals, the one that set off later met the other on its way.
  std::ranges::stable_sort(reasons.begin(), reasons.begin() + std::ssize(fatal), std::greater{}, [](const Reason& r) {
    const ReasonLine* decisive = r.decisive();
    return std::pair(decisive == nullptr ? 0 : static_cast<int>(decisive->weight), r.decided_us);
  });
  for (const std::size_t body : idle) {
    Reason none;
    none.is_fatal = true;
    none.title = film.bodies[body].name + " had begun nothing before the failure";
    reasons.insert(reasons.begin() + static_cast<std::ptrdiff_t>(fatal.size()), std::move(none));
  }
  return reasons;
}

}  // namespace fleetproof::web
