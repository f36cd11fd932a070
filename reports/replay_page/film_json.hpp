#pragma once

#include <string>

#include "reports/replay_page/film.hpp"

namespace fleetproof::web {

// The film as the JSON that the scripts of the page read; README.md has the members. It stands inside an element of the
// page, so it has no character that starts markup: < > & are written as \u escapes, within strings only.
std::string film_json(const Film& film);

}  // namespace fleetproof::web
