#pragma once

#include <vector>

#include "reports/replay_page/drive_reasons.hpp"
#include "reports/replay_page/film.hpp"

namespace fleetproof::web {

// The messages whose delivery the scenario decides, for the head of the page: the last ones before the failure,
// each with the instant at which it was sent, and how many there are besides. Empty: there is none.
std::vector<ReasonLine> given_delivery_lines(const Film& film);

}  // namespace fleetproof::web
