#pragma once

#include "core/geometry/pose.hpp"

namespace fleetproof {

// A straight line (curvature 0) or a circular arc, from `start` along its heading. Positive curvature turns left.
struct Arc {
  Pose start;
  double length_m = 0.0;
  double curvature_per_m = 0.0;

  Pose pose_at(double s_m) const;
  // The same arc driven the other way.
  Arc reversed() const;
};

}  // namespace fleetproof
