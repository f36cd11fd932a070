#pragma once

#include <cstddef>

#include "reports/markup/markup.hpp"
#include "reports/replay_page/film.hpp"

namespace fleetproof::web {

// A curve of film.clearances as a figure. The script of the page finds its scale in data attributes and moves the line
// of the present instant.
html::Element draw_clearance(const Film& film, std::size_t curve);

}  // namespace fleetproof::web
