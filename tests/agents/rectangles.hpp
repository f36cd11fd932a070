#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/sdk/fleetproof/agent.h"

// Clearance of two bodies, side by side. It shares no code with the geometry of the agents or of the judge.
namespace fleetproof::agents::testing {

struct Point {
  double x, y;
};

inline std::array<Point, 4> corners(const fp_pose& pose, double length_m, double width_m) {
  std::array<Point, 4> c{};
  const double u[] = {1, 1, -1, -1}, v[] = {1, -1, -1, 1};
  for (std::size_t i = 0; i < 4; ++i) {
    const double along = u[i] * length_m / 2, across = v[i] * width_m / 2;
    c[i] = {pose.x_m + along * pose.heading_x - across * pose.heading_y,
            pose.y_m + along * pose.heading_y + across * pose.heading_x};
  }
  return c;
}

inline double distance(Point p, Point a, Point b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  const double t = std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
  return std::hypot(p.x - a.x - t * dx, p.y - a.y - t * dy);
}

inline double cross(Point a, Point b, Point p) { return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x); }

inline bool contains(const std::array<Point, 4>& box, Point p) {
  for (std::size_t i = 0; i < 4; ++i) {
    if (cross(box[i], box[(i + 1) % 4], p) > 0) return false;  // corners run clockwise
  }
  return true;
}

// 0 if they touch.
inline double clearance_m(const std::array<Point, 4>& a, const std::array<Point, 4>& b) {
  double least_m = 1e9;
  for (std::size_t i = 0; i < 4; ++i) {
    if (contains(a, b[i]) || contains(b, a[i])) return 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
      const Point &p = a[i], &q = a[(i + 1) % 4], &r = b[k], &s = b[(k + 1) % 4];
      if (cross(p, q, r) * cross(p, q, s) < 0 && cross(r, s, p) * cross(r, s, q) < 0) return 0.0;
      least_m = std::min({least_m, distance(p, r, s), distance(r, p, q)});
    }
  }
  return least_m;
}

// On the arc, `s_m` from its start.
inline fp_pose on_arc(const fp_arc& arc, double s_m) {
  const double angle = arc.curvature_per_m * s_m, c = std::cos(angle), s = std::sin(angle);
  const double hx = arc.start.heading_x, hy = arc.start.heading_y;
  const double along = arc.curvature_per_m == 0.0 ? s_m : s / arc.curvature_per_m;
  const double left = arc.curvature_per_m == 0.0 ? 0.0 : (1 - c) / arc.curvature_per_m;
  return {arc.start.x_m + along * hx - left * hy, arc.start.y_m + along * hy + left * hx, c * hx - s * hy,
          s * hx + c * hy};
}

inline fp_pose on_lane(const fp_lane& lane, double s_m) {
  std::uint32_t i = 0;
  for (; i + 1 < lane.arc_count && s_m > lane.arcs[i].length_m; ++i) s_m -= lane.arcs[i].length_m;
  return on_arc(lane.arcs[i], std::min(s_m, lane.arcs[i].length_m));
}

}  // namespace fleetproof::agents::testing
