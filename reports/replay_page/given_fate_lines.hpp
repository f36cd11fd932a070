#pragma once

#include <vector>

#include "reports/replay_page/drive_reasons.hpp"
#include "reports/replay_page/film.hpp"

namespace fleetproof::web {

// The messages of which the scenario gives the fate, for the head of the page: the last ones before the failure, each
// with the instant at which it was sent, and how many there are besides. Empty: there is none.
std::vector<ReasonLine> given_fate_lines(const Film& film);

}  // namespace fleetproof::web
