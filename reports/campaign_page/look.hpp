#pragma once

#include "reports/markup/markup.hpp"

namespace fleetproof::html {

// Colours and spacing. The page can be read without them.
Literal part_styles();  // stands before the other
Literal style_sheet();
// Sorting of tables by a click on a column's head, and a filter above long tables. The page can do without them.
Literal script();

}  // namespace fleetproof::html
