#include "core/geometry/curve.hpp"

#include <algorithm>
#include <utility>

#include "core/geometry/biarc.hpp"
#include "core/geometry/rotation.hpp"

namespace fleetproof {

Pose Arc::pose_at(double s_m) const {
  if (curvature_per_m == 0.0) return {start.position_m + s_m * start.heading, start.heading};
  // By the chord, which leaves the start at half the angle turned: exact also for a radius so large that 1 - cos would
  // cancel.
  const Vec2 half = unit_vector(0.5 * curvature_per_m * s_m);
  const Vec2 chord_heading = rotated(start.heading, half);
  return {start.position_m + (2.0 * half.y() / curvature_per_m) * chord_heading, rotated(chord_heading, half)};
}

Curve::Curve(std::vector<Arc> arcs) : arcs_(std::move(arcs)) {
  double length_m = 0.0;
  for (const Arc& arc : arcs_) ends_m_.push_back(length_m += arc.length_m);
}

Curve Curve::straight(const Vec2& from_m, const Vec2& to_m) {
  const Vec2 way = to_m - from_m;
  const double length_m = way.norm();
  return Curve({Arc{{from_m, length_m > 0.0 ? Vec2(way / length_m) : Vec2(Vec2::UnitX())}, length_m, 0.0}});
}

Curve Curve::bezier(const Vec2& p0_m, const Vec2& p1_m, const Vec2& p2_m, const Vec2& p3_m, double tolerance_m) {
  return Curve(biarc_chain({p0_m, p1_m, p2_m, p3_m}, tolerance_m));
}

Curve Curve::joined(std::span<const Curve> parts) {
  std::vector<Arc> arcs;
  for (const Curve& part : parts) arcs.insert(arcs.end(), part.arcs_.begin(), part.arcs_.end());
  return Curve(std::move(arcs));
}

Pose Curve::pose_at(double s_m) const {
  if (arcs_.empty()) return {};
  const double s = std::clamp(s_m, 0.0, length_m());
  if (arcs_.size() == 1) return arcs_[0].pose_at(s);
  const Arc& arc = arc_at(s);
  const auto index = static_cast<std::size_t>(&arc - arcs_.data());
  return arc.pose_at(index == 0 ? s : s - ends_m_[index - 1]);
}

const Arc& Curve::arc_at(double s_m) const {
  const auto next = std::upper_bound(ends_m_.begin(), ends_m_.end() - 1, s_m);
  return arcs_[static_cast<std::size_t>(next - ends_m_.begin())];
}

Curve Curve::reversed() const {
  std::vector<Arc> arcs;
  for (auto arc = arcs_.rbegin(); arc != arcs_.rend(); ++arc) {
    const Pose end = arc->pose_at(arc->length_m);
    arcs.push_back({{end.position_m, -end.heading}, arc->length_m, -arc->curvature_per_m});
  }
  return Curve(std::move(arcs));
}

}  // namespace fleetproof
