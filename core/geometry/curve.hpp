#pragma once

#include <span>
#include <vector>

#include "core/base/tolerances.hpp"
#include "core/geometry/pose.hpp"

namespace fleetproof {

// A straight line (curvature 0) or a circular arc, from `start` along its heading. Positive curvature turns left.
struct Arc {
  Pose start;
  double length_m = 0.0;
  double curvature_per_m = 0.0;

  Pose pose_at(double s_m) const;
};

// A track on the floor by arc length: arcs joined without kinks (heading continuous to kKink_rad). Points and curvature
// are exact in closed form.
class Curve {
 public:
  Curve() = default;
  explicit Curve(std::vector<Arc> arcs);

  static Curve straight(const Vec2& from_m, const Vec2& to_m);
  // A cubic Bezier as a chain of arcs that stays within `tolerance_m` of it; ends and end tangents are exact.
  static Curve bezier(const Vec2& p0_m, const Vec2& p1_m, const Vec2& p2_m, const Vec2& p3_m,
                      double tolerance_m = kBezierByArcs_m);
  // Curves driven one after the other.
  static Curve joined(std::span<const Curve> parts);

  double length_m() const { return ends_m_.empty() ? 0.0 : ends_m_.back(); }
  Pose pose_at(double s_m) const;  // s clamped to [0, length]
  const Arc& arc_at(double s_m) const;
  // Arc lengths at which one arc ends and the next begins; the last is the whole length.
  std::span<const double> ends_m() const { return ends_m_; }
  std::span<const Arc> arcs() const { return arcs_; }
  bool is_straight() const { return arcs_.size() == 1 && arcs_[0].curvature_per_m == 0.0; }

  // The same track driven the other way.
  Curve reversed() const;

 private:
  std::vector<Arc> arcs_;
  std::vector<double> ends_m_;
};

}  // namespace fleetproof
