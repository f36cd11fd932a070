#pragma once

#include <vector>

#include "reports/html/markup.hpp"
#include "reports/web/film.hpp"

namespace fleetproof::web {

// The run as tables, for readers without scripts: violations, who waits for whom, faults, orders; the first 500 rows of
// each. A table without rows is left out.
std::vector<html::Element> table_parts(const Film& film);

}  // namespace fleetproof::web
