#pragma once

#include <cstddef>

#include "reports/replay_page/film.hpp"
#include "reports/replay_page/film_words.hpp"

namespace fleetproof::web {

// The activity with which the AGV set off: the earliest that may have been decided together with this one. It is an
// earlier one if the AGV has moved without a rest since, and its agent still says the word that it said then. A word
// that was said at another instant, or never, tells nothing: then it is the activity itself.
std::size_t setting_off(const Film& film, std::size_t activity);

// When the agent called for an activity. If that is not known: when it began.
Moment decision_on(const ActivityBar& bar);

// Whether the AGV drives or turns.
bool is_motion(const ActivityBar& bar);
// The activity before it, of the same body, if the AGV went from one into the other without a rest. Else: `activity`.
std::size_t rolled_from(const Film& film, std::size_t activity);

}  // namespace fleetproof::web
