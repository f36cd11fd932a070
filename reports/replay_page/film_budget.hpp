#pragma once

#include <cstddef>

#include "reports/replay_page/film.hpp"

namespace fleetproof::web {

// How many bytes the page may spend on what a run can have without limit. A fleet of 50 sends and believes a million
// things in ten minutes, of which nobody looks at more than a few.
struct FilmBudget {
  std::size_t message_bytes = 1'300'000, belief_bytes = 800'000, happening_bytes = 350'000, state_bytes = 350'000,
              wait_bytes = 250'000;
};

// Keeps what is nearest to the failure: in time, before it rather than after it, and of the bodies involved. What is
// left out is said in film.left_out, with the time for which nothing is. Motions and activities stay whole.
void keep_within(Film& film, const FilmBudget& budget = {});

}  // namespace fleetproof::web
