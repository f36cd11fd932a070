#pragma once

#include "reports/html/markup.hpp"
#include "reports/web/film_course.hpp"

namespace fleetproof::web {

// The course as a list. A line that stands for several opens; with scripts, a click on a line goes to its instant.
html::Element course_part(const Course& course);

}  // namespace fleetproof::web
