#pragma once

#include "reports/markup/markup.hpp"
#include "reports/replay_page/film_course.hpp"

namespace fleetproof::web {

// The course as a list. A line that stands for several opens; with scripts, a click on a line goes to its instant.
html::Element course_part(const Course& course);

}  // namespace fleetproof::web
