#pragma once

#include "reports/web/film.hpp"

namespace fleetproof {

// What the words of agents in this run mean, as far as the project's agents use them: notes, states, and words in the
// contents of messages.
void add_glossary(web::Film& film);

}  // namespace fleetproof
