#pragma once

#include <string>

#include "core/geometry/pose.hpp"

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

}  // namespace fleetproof
