#pragma once

#include <string>

#include "core/scenario/layout.hpp"

namespace fleetproof {

// The layout as a picture, to scale, with y upwards. It shows lanes (with arrow heads if one-way) and stations with
// their names. Each purpose has a shape and a colour. There are a legend and a scale bar. It is plain SVG with
// presentation attributes only, so that every viewer shows it. The same layout gives the same bytes. Requires:
// problems_of(layout) is empty.
std::string layout_svg(const Layout& layout);

}  // namespace fleetproof
