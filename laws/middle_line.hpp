#pragma once

#include "core/geometry/curve.hpp"
#include "core/geometry/rectangle.hpp"

namespace fleetproof {

// The middle of the track of a straight drive, from the tail of the body at the start to its nose at the end. What two
// straight tracks are to each other is often plain from it, without the points of the tracks.
struct MiddleLine {
  Vec2 begin_m = Vec2::Zero(), travel = Vec2::UnitX();
  double length_m = 0.0;

  // Requires: the curve is straight.
  static MiddleLine of(const Curve& curve, const Footprint& footprint);
  Vec2 end_m() const { return begin_m + length_m * travel; }
  // From a point to the nearest one of the line.
  double square_distance_m2(const Vec2& point_m) const;
  // True only if the lines are farther apart than this: most lines that are so are found.
  static bool are_apart(const MiddleLine& a, const MiddleLine& b, double distance_m) {
    return a.has_aside(b, distance_m) || b.has_aside(a, distance_m);
  }

 private:
  bool has_aside(const MiddleLine& other, double distance_m) const;
};

}  // namespace fleetproof
