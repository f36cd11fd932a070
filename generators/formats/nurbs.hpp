#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/tolerances.hpp"
#include "core/geometry/pose.hpp"

namespace fleetproof {

// A planar NURBS curve as layout files give it.
struct Nurbs {
  std::size_t degree = 1;
  std::vector<double> knots;
  std::vector<Vec2> points_m;
  std::vector<double> weights;  // one per point
  friend bool operator==(const Nurbs&, const Nurbs&) = default;
};

// What is wrong with the numbers of a curve, with a remedy; empty if the curve is valid.
std::string fault_of(const Nurbs& nurbs);

// The curve in the form of a segment: cubic Bezier pieces between `begin_m` and `end_m`.
struct CubicPieces {
  Vec2 begin_m = Vec2::Zero(), end_m = Vec2::Zero();
  std::vector<Vec2> control_points_m;  // none: straight; else 2, 5, 8, ...
  double off_m = 0.0;                  // how far they are from the given curve at most; 0: they are the curve
};

// How far pieces may be from their curve, in place and heading.
struct NearCurve {
  double m = kNurbsByCubics_m, rad = kNurbsByCubics_rad;
};

// Exact for clamped curves with equal weights in Bezier form, up to degree 3, and for polylines without corners. The
// corners of other polylines are rounded (round_corners). Pieces of any other curve are as near to it as `near` says.
// Their corners remain, unless they are less than kSmoothedKink_rad. Requires: `nurbs` is valid.
CubicPieces cubic_pieces(const Nurbs& nurbs, const NearCurve& near = {});

// A curve that begins or ends this far beside its point is not drawn to it: that is half an AGV, whose body would be
// judged where it never drives.
inline constexpr double kFarBeside_m = 1.0;

// Why a curve that is drawn from `begin_m` to `end_m` does not lead from one of two points to the other, with a remedy;
// empty if it does, to kFarBeside_m. `point` is what the file calls a point, such as "node".
std::string fault_of_ends(const Vec2& begin_m, const Vec2& end_m, const Vec2& from_m, const Vec2& to_m,
                          std::string_view point);

}  // namespace fleetproof
