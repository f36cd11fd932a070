#pragma once

#include <string>

#include "core/scenario/layout.hpp"

namespace fleetproof {

// The layout as a picture, y upwards, to scale: lanes (arrow heads where one-way), stations with their names, each
// purpose with a shape and a colour of its own, a legend and a scale bar. Plain SVG with presentation attributes only,
// so that every viewer shows it; the same layout gives the same bytes. The layout must be sound (problems_of() is
// empty).
std::string layout_svg(const Layout& layout);

}  // namespace fleetproof
