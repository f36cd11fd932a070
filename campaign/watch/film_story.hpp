#pragma once

#include "campaign/watch/film_clearances.hpp"
#include "core/outcome/outcome.hpp"
#include "core/scenario/scenario.hpp"
#include "reports/replay_page/film.hpp"

namespace fleetproof {

// What happened, in plain words: sets title, story, failed, focus, involved and the first instant that the page shows.
// The first failure leads: a violation, else a crash or hang, else AGVs that wait for each other. Requires: all that
// the trace said is in the film.
void tell_story(web::Film& film, const Scenario& scenario, const PiecesOfBodies& bodies, const Outcome& outcome);

}  // namespace fleetproof
