#include "core/geometry/arc.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/tolerances.hpp"
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

Arc Arc::reversed() const {
  const Pose end = pose_at(length_m);
  return {{end.position_m, -end.heading}, length_m, -curvature_per_m};
}

namespace {

constexpr int kDeepest = 12;
constexpr double kBack = -0.99;  // cosine between a heading and a way that leads back

Vec2 direction_of(const Vec2& way, const Vec2& otherwise) {
  const double length = way.norm();
  return length > kSamePoint_m ? Vec2(way / length) : otherwise;
}

// The arc that leaves `start` along its heading and ends in `end`.
Arc arc_to(const Pose& start, const Vec2& end_m) {
  const Vec2 chord = end_m - start.position_m;
  const double chord_m = chord.norm();
  if (chord_m <= kSamePoint_m) return {start, 0.0, 0.0};
  const double half_rad = angle_between(start.heading, chord / chord_m);
  if (std::abs(half_rad) < kStraightArc_rad) return {{start.position_m, chord / chord_m}, chord_m, 0.0};
  const double sine = unit_vector(half_rad).y();
  return {start, chord_m * half_rad / sine, 2.0 * sine / chord_m};
}

// Two arcs from a pose to a point and a heading there. Both lie in isosceles triangles, so neither turns by more than
// pi.
std::array<Arc, 2> biarc(const Pose& from, const Pose& to) {
  const Vec2 way = to.position_m - from.position_m;
  const double squared = way.squaredNorm();
  if (squared <= kSamePoint_m * kSamePoint_m) return {Arc{from, 0.0, 0.0}, Arc{from, 0.0, 0.0}};
  // Leg d of both triangles: d^2 (2 - 2 cos) + 2 d (way . sum) = way^2, where cos is that of the turn from one heading
  // to the other.
  const auto leg_m = [&](const Vec2& heading) {
    const double along = way.dot(from.heading + heading), spread = (from.heading - heading).squaredNorm();
    const double root = std::sqrt(along * along + spread * squared);
    if (along > 0.0) return squared / (along + root);
    return spread > 0.0 ? (root - along) / spread : std::numeric_limits<double>::infinity();
  };
  Vec2 heading = to.heading;
  double leg = leg_m(heading);
  // Headings that point back along the way need very large circles, or have no joint at all. The arcs then arrive with
  // another heading, and the next arcs turn the rest.
  const Vec2 ahead = direction_of(way, from.heading);
  if (!(leg * leg < 1e4 * squared) || ahead.dot(from.heading) < kBack) {
    heading = ahead.dot(from.heading) < kBack ? left_of(ahead) : ahead;
    leg = leg_m(heading);
  }
  const Vec2 joint = 0.5 * (from.position_m + to.position_m + leg * (from.heading - heading));
  const Arc first = arc_to(from, joint);
  return {first, arc_to(first.pose_at(first.length_m), to.position_m)};
}

// How far a point lies beside the circle that an arc is part of.
double off_circle_m(const Arc& arc, const Vec2& point_m) {
  const Vec2 offset = point_m - arc.start.position_m;
  const double aside = cross(arc.start.heading, offset);
  const double k = arc.curvature_per_m, bend = k * offset.squaredNorm() - 2.0 * aside;
  // Distance from the centre minus radius, without either: exact for large radii.
  return std::abs(bend) / (1.0 + std::sqrt(std::max(0.0, 1.0 + k * bend)));
}

// The heading of an arc beside a point.
Vec2 heading_beside(const Arc& arc, const Vec2& point_m) {
  const Vec2 offset = point_m - arc.start.position_m;
  return direction_of(arc.start.heading + arc.curvature_per_m * left_of(offset), arc.start.heading);
}

class Chain {
 public:
  Chain(const std::array<Vec2, 4>& control_points, const ArcTolerance& tolerance)
      : p_(control_points), tolerance_(tolerance) {}

  std::vector<Arc> arcs() {
    at_ = {point(0.0), start_heading()};
    span(0.0, 1.0, 0);
    return arcs_;
  }

 private:
  Vec2 point(double t) const {
    const double u = 1.0 - t;
    return u * u * u * p_[0] + 3.0 * u * u * t * p_[1] + 3.0 * u * t * t * p_[2] + t * t * t * p_[3];
  }

  Vec2 start_heading() const {
    const Vec2 last = direction_of(p_[3] - p_[0], Vec2::UnitX());
    return direction_of(p_[1] - p_[0], direction_of(p_[2] - p_[0], last));
  }

  Vec2 heading(double t) const {
    const double u = 1.0 - t;
    const Vec2 a = p_[1] - p_[0], b = p_[2] - p_[1], c = p_[3] - p_[2];
    // Where the speed of the parameter vanishes, the change of the speed shows the way on.
    const Vec2 onward = direction_of(u * (b - a) + t * (c - b), at_.heading);
    if (t < 1.0) return direction_of(u * u * a + 2.0 * u * t * b + t * t * c, onward);
    return direction_of(c, direction_of(p_[3] - p_[1], direction_of(p_[3] - p_[0], at_.heading)));
  }

  // Before the call, the arcs end in `at_`, at the parameter `from`. After the call, they end at `to`.
  void span(double from, double to, int depth) {
    const Pose end{point(to), heading(to)};
    const auto pair = biarc(at_, end);
    if (depth < kDeepest && !fits(pair, from, to)) {
      const double middle = 0.5 * (from + to);
      span(from, middle, depth + 1);
      span(middle, to, depth + 1);
      return;
    }
    for (const Arc& arc : pair) {
      if (arc.length_m > 0.0) arcs_.push_back(arc);
    }
    if (!arcs_.empty()) at_ = arcs_.back().pose_at(arcs_.back().length_m);
  }

  bool fits(const std::array<Arc, 2>& pair, double from, double to) const {
    constexpr int kSamples = 8;
    for (const Arc& arc : pair) {
      if (std::abs(arc.curvature_per_m) * arc.length_m > 0.5 * kPi) return false;
    }
    const Pose& joint = pair[1].start;
    const Pose end = pair[1].pose_at(pair[1].length_m);
    if ((end.heading - heading(to)).norm() > kKink_rad) return false;
    for (int i = 1; i < kSamples; ++i) {
      const double t = from + (to - from) * i / kSamples;
      const Vec2 sample = point(t);
      if ((sample - at_.position_m).dot(at_.heading) < -0.5 * tolerance_.position_m) return false;
      if ((sample - end.position_m).dot(end.heading) > 0.5 * tolerance_.position_m) return false;
      const Arc& nearer = (sample - joint.position_m).dot(joint.heading) < 0.0 ? pair[0] : pair[1];
      if (off_circle_m(nearer, sample) > 0.8 * tolerance_.position_m) return false;
      // A third is kept back for what lies between the samples: the error is largest at the joint.
      if ((heading_beside(nearer, sample) - heading(t)).norm() > 0.67 * tolerance_.heading_rad) return false;
    }
    return true;
  }

  std::array<Vec2, 4> p_;
  ArcTolerance tolerance_;
  Pose at_;
  std::vector<Arc> arcs_;
};

}  // namespace

bool is_straight_bezier(const std::array<Vec2, 4>& p) {
  const Vec2 way = p[3] - p[0];
  const double length = way.norm();
  return std::all_of(p.begin() + 1, p.begin() + 3, [&](const Vec2& point) {
    if ((point - p[0]).norm() <= kSamePoint_m || (point - p[3]).norm() <= kSamePoint_m) return true;
    const double along = way.dot(point - p[0]), aside = cross(way, point - p[0]);
    return length > kSamePoint_m && std::abs(aside) <= kOnTheLine * length && along >= 0.0 && along <= length * length;
  });
}

std::vector<Arc> biarc_chain(const std::array<Vec2, 4>& control_points_m, const ArcTolerance& tolerance) {
  const Vec2 origin = control_points_m[0], way = control_points_m[3] - origin;
  const std::vector<Arc> line{Arc{{origin, direction_of(way, Vec2::UnitX())}, way.norm(), 0.0}};
  if (is_straight_bezier(control_points_m)) return line;
  // Relative to the first point: far from the world's origin the arcs would lose digits.
  std::array<Vec2, 4> relative;
  std::transform(control_points_m.begin(), control_points_m.end(), relative.begin(),
                 [&](const Vec2& p) { return Vec2(p - origin); });
  std::vector<Arc> arcs = Chain(relative, tolerance).arcs();
  for (Arc& arc : arcs) arc.start.position_m += origin;
  return arcs.empty() ? line : arcs;
}

}  // namespace fleetproof
