// How fast a Bezier curve bends, with bounds that hold on the whole curve.
#pragma once

#include <array>
#include <optional>

#include "core/geometry/pose.hpp"

namespace fleetproof {

// A cubic Bezier curve as a polynomial of its parameter: origin + u (a + u (b + u c)).
struct Cubic {
  Vec2 origin_m = Vec2::Zero();
  Vec2 a = Vec2::Zero(), b = Vec2::Zero(), c = Vec2::Zero();

  static Cubic bezier(const std::array<Vec2, 4>& control_points_m);
  Vec2 point_m(double u) const { return origin_m + u * (a + u * (b + u * c)); }
  Vec2 velocity(double u) const { return a + u * (2.0 * b + 3.0 * u * c); }
  Vec2 acceleration(double u) const { return 2.0 * b + 6.0 * u * c; }
  // The control points of the part between two parameters, relative to `origin_m`.
  std::array<Vec2, 4> control_points_m(double from, double to) const;
};

// How a track bends. Positive values turn left, or come to turn left.
struct Bending {
  double per_m = 0.0;   // curvature
  double per_m2 = 0.0;  // its change with the arc length
};

// The largest magnitudes on a part of a track.
struct MostBending {
  double per_m = 0.0, per_m2 = 0.0, per_m3 = 0.0;
};

// A part of a cubic Bezier curve by arc length. Every pose is a point of the curve with the heading of the curve there,
// up to rounding. Which point it is, is right to kAlongCurve_m: the parameter is a polynomial of the arc length.
class Bend {
 public:
  // Nothing if the part is too long or too sharp for one polynomial: shorter parts may do.
  static std::optional<Bend> of(const Cubic& cubic, double from, double to);

  double length_m() const { return length_m_; }
  const MostBending& most() const { return most_; }
  // Requires: 0 <= s_m <= length_m().
  Pose pose_at(double s_m) const;
  Bending bending_at(double s_m) const;

  // The same part driven the other way.
  Bend reversed() const;
  Bend moved(const Vec2& by_m) const;

 private:
  bool measure(double to);
  bool bound(double to);
  double parameter_at(double s_m) const;

  Cubic cubic_;
  double from_ = 0.0, length_m_ = 0.0;
  bool reversed_ = false;
  std::array<double, 8> parameter_{};  // by the share of the length
  MostBending most_;
};

}  // namespace fleetproof
