// A layout, or a moment of a run, as a picture in SVG.
#pragma once

#include <string>

#include "core/geometry/pose.hpp"
#include "core/scenario/layout.hpp"

namespace fleetproof {

// Where the floor is in a picture: to scale, with y upwards, 960 pixels wide. There is room above it for a title and
// below it for the axis and `foot_px` of words.
class FloorView {
 public:
  // Requires: a floor with low <= high.
  FloorView(const Vec2& low_m, const Vec2& high_m, double foot_px);

  Vec2 pixel(const Vec2& p_m) const;
  double scale() const { return scale_; }  // pixels per metre
  double width_px() const;
  double height_px() const { return foot_top_px() + foot_px_; }
  double margin_px() const;
  double foot_top_px() const;

  // Lines and numbers of both axes, in metres, as SVG: one group for each axis. The same view gives the same bytes.
  std::string axes() const;

 private:
  Vec2 low_m_, high_m_;
  double foot_px_, scale_, left_px_;
};

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
