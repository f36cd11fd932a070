#pragma once

#include "core/geometry/pose.hpp"

namespace fleetproof {

// The size of a body, seen from above. The length is along the heading. The reference point follows the track, and the
// body turns about it on the spot.
struct Footprint {
  double length_m = 1.6;
  double width_m = 1.0;
  double centre_ahead_m = 0.0;  // from the reference point to the centre, along the heading

  // From the reference point to the farthest corner.
  double reach_m() const;
  friend bool operator==(const Footprint&, const Footprint&) = default;
};

// A footprint at a place on the floor.
struct OrientedRectangle {
  Vec2 centre_m = Vec2::Zero();
  Vec2 heading = Vec2::UnitX();  // unit vector along the length
  double half_length_m = 0.0;
  double half_width_m = 0.0;
};

OrientedRectangle placed(const Footprint& footprint, const Pose& pose);
// The rectangle with every side moved outwards by `margin_m`. It contains all points within `margin_m`. Its corners are
// square and reach up to 0.414 margins too far.
OrientedRectangle widened(const OrientedRectangle& rectangle, double margin_m);

// The relative position of two rectangles.
struct Separation {
  // Above zero: the Euclidean distance. Else: minus the depth of the shallowest overlap over the side directions.
  double clearance_m = 0.0;
  // Unit vector from the first towards the second, along the closest points, or along the shallowest axis.
  Vec2 direction = Vec2::UnitX();
};

// The exact planar distance. The error is below 1e-12 m for bodies within 1 km. The sign is right beyond this error.
Separation separation(const OrientedRectangle& first, const OrientedRectangle& second);
double clearance_m(const OrientedRectangle& first, const OrientedRectangle& second);

// An axis-aligned box. It only selects candidates; it never decides.
struct Box {
  Vec2 low_m = Vec2::Constant(1e300);
  Vec2 high_m = Vec2::Constant(-1e300);

  void add(const Vec2& point_m) {
    low_m = low_m.cwiseMin(point_m);
    high_m = high_m.cwiseMax(point_m);
  }
  void add(const OrientedRectangle& rectangle);
  void add(const Box& other) {
    low_m = low_m.cwiseMin(other.low_m);
    high_m = high_m.cwiseMax(other.high_m);
  }
  Box grown(double margin_m) const { return {low_m - Vec2::Constant(margin_m), high_m + Vec2::Constant(margin_m)}; }
  bool overlaps(const Box& other) const {
    return low_m.x() <= other.high_m.x() && other.low_m.x() <= high_m.x() && low_m.y() <= other.high_m.y() &&
           other.low_m.y() <= high_m.y();
  }
  bool contains(const Box& other) const {
    return low_m.x() <= other.low_m.x() && other.high_m.x() <= high_m.x() && low_m.y() <= other.low_m.y() &&
           other.high_m.y() <= high_m.y();
  }
};

}  // namespace fleetproof
