#include "reports/replay_page/setting_off.hpp"

#include <cstdint>
#include <cstdlib>

namespace fleetproof::web {
namespace {

// An agent says its word right before or right after its call, perhaps in another activation.
constexpr std::int64_t kContiguous_us = 1'000, kSetOffAtOnce_us = 100'000;

const Declared* last_word(const Film& film, const ActivityBar& bar) {
  const Declared* last = nullptr;
  for (const Declared& state : film.states) {
    if (state.body == bar.body && state.at_us <= bar.begin_us) last = &state;
  }
  return last;
}

}  // namespace

Moment decision_on(const ActivityBar& bar) {
  return bar.commanded_us ? Moment{*bar.commanded_us, bar.commanded_order} : Moment{bar.begin_us, bar.begin_order};
}

bool is_motion(const ActivityBar& bar) { return bar.kind == "drive" || bar.kind == "turn"; }

std::size_t rolled_from(const Film& film, std::size_t activity) {
  for (std::size_t i = activity; i-- > 0;) {
    const ActivityBar& bar = film.activities[i];
    if (bar.body != film.activities[activity].body) continue;
    return is_motion(bar) && bar.end_us + kContiguous_us >= film.activities[activity].begin_us ? i : activity;
  }
  return activity;
}

std::size_t setting_off(const Film& film, std::size_t activity) {
  if (!is_motion(film.activities[activity])) return activity;
  const Declared* word = last_word(film, film.activities[activity]);
  if (word == nullptr || word->word.empty()) return activity;
  std::size_t first = activity;
  for (std::size_t i = activity;;) {
    if (std::abs(film.activities[i].begin_us - word->at_us) <= kSetOffAtOnce_us) first = i;
    const std::size_t before = rolled_from(film, i);
    if (before == i || film.activities[i].begin_us < word->at_us - kSetOffAtOnce_us) return first;
    i = before;
  }
}

}  // namespace fleetproof::web
