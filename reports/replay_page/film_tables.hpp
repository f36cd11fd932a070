#pragma once

#include <vector>

#include "reports/markup/markup.hpp"
#include "reports/replay_page/film.hpp"

namespace fleetproof::web {

// The run as tables, for readers without scripts: violations, who waits for whom, faults, orders; the first 500 rows of
// each. A table without rows is left out.
std::vector<html::Element> table_parts(const Film& film);

}  // namespace fleetproof::web
