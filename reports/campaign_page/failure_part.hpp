#pragma once

#include <cstdint>
#include <map>

#include "reports/markup/film_strip.hpp"
#include "reports/markup/markup.hpp"
#include "reports/sections/report_input.hpp"

namespace fleetproof::html {

// By the index of the run that a strip shows.
using FilmStrips = std::map<std::uint64_t, FilmStrip>;

// Failing runs by agent, end point and first cause, at most 50 groups: a table, then the worst run of each group with
// its replay line and its strip, if there is one.
Element failure_part(const ReportInput& input, const FilmStrips& strips);

}  // namespace fleetproof::html
