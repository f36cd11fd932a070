#pragma once

#include <vector>

#include "reports/html/markup.hpp"
#include "reports/web/film.hpp"

namespace fleetproof::web {

// The run as tables, for readers without scripts: violations, events and messages around the failure, who waits for
// whom, faults, orders. A table without rows is left out.
std::vector<html::Element> table_parts(const Film& film);

}  // namespace fleetproof::web
