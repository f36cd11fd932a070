#pragma once

#include <string>

#include "core/scenario/layout.hpp"
#include "generators/map/floor_view.hpp"

namespace fleetproof {

// The layout as a picture, to scale, with y upwards. It shows lanes (with arrow heads if one-way) and stations with
// their names. Each purpose has a shape and a colour. There are a legend, a scale bar and axes in metres. It is plain
// SVG with presentation attributes only, so that every viewer shows it. The same layout gives the same bytes. Requires:
// problems_of(layout) is empty.
std::string layout_svg(const Layout& layout);

// What a picture shows besides the layout. The parts are SVG, with text that is escaped already; the title is text.
struct OnFloor {
  std::string title;          // empty: that of the layout
  std::string under_the_map;  // drawn before lanes and stations
  std::string on_the_map;     // drawn before the names of stations, which stay readable, and before the legend
};

// The view for floor_svg. `words_px`: height of what stands below the legend, from words_top_px() on.
FloorView view_of(const Layout& layout, double words_px = 0.0);
double words_top_px(const FloorView& view);
std::string floor_svg(const Layout& layout, const FloorView& view, const OnFloor& on_floor);

}  // namespace fleetproof
