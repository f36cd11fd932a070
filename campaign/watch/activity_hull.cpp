#include "campaign/watch/activity_hull.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/rotation.hpp"

namespace fleetproof {
namespace {

constexpr double kMostHullSteps = 1000.0;

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

void add_corners(Polygon& points, const OrientedRectangle& body) {
  const Vec2 along = body.half_length_m * body.heading,
             aside = body.half_width_m * Vec2(-body.heading.y(), body.heading.x());
  for (const Vec2& corner : {Vec2(along + aside), Vec2(aside - along), Vec2(-along - aside), Vec2(along - aside)})
    points.push_back(body.centre_m + corner);
}

// Half of the convex hull of points in order of x, then y.
template <class Points>
void add_chain(Polygon& hull, const Points& points) {
  const std::size_t begin = hull.size();
  for (const Vec2& p : points) {
    while (hull.size() >= begin + 2 && cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0.0)
      hull.pop_back();
    hull.push_back(p);
  }
  hull.pop_back();  // the first point of the other half
}

Polygon wrapped(const OrientedRectangle& one, const OrientedRectangle& other) {
  Polygon points, hull;
  add_corners(points, one);
  add_corners(points, other);
  std::ranges::sort(points,
                    [](const Vec2& a, const Vec2& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  add_chain(hull, points);
  std::ranges::reverse(points);
  add_chain(hull, points);
  return hull;
}

void add_part(Hull& hull, const OrientedRectangle& one, const OrientedRectangle& other) {
  hull.parts.push_back(wrapped(one, other));
  hull.box.add(one);
  hull.box.add(other);
}

// Between poses that are so near, no corner is farther than kHullSlack_m from its chord: the second derivative of its
// path, times the squared length / 8, bounds the distance.
int steps_for(double sagitta_m) {
  return 1 + static_cast<int>(std::min(std::sqrt(sagitta_m / kHullSlack_m), kMostHullSteps));
}

void add_drive(Hull& hull, const Piece& piece) {
  const double from_m = piece.way_begin_m, to_m = piece.way_at(piece.end), arm_m = piece.footprint.reach_m();
  const auto ends_m = piece.curve->ends_m();
  double begin_m = 0.0;
  for (std::size_t i = 0; i < ends_m.size(); begin_m = ends_m[i++]) {
    const double low_m = std::max(from_m, begin_m), high_m = std::min(to_m, ends_m[i]), length_m = high_m - low_m;
    if (!(length_m > 0.0)) continue;
    const MostBending& most = piece.curve->parts()[i].most();
    const double turned_rad = most.per_m * length_m;
    const int steps =
        steps_for(((length_m + arm_m * turned_rad) * turned_rad + arm_m * most.per_m2 * length_m * length_m) / 8.0);
    const auto body_at = [&](int step) {
      return placed(piece.footprint, piece.curve->pose_at(low_m + length_m * step / steps));
    };
    for (int step = 0; step < steps; ++step) add_part(hull, body_at(step), body_at(step + 1));
  }
}

void add_turn(Hull& hull, const Piece& piece) {
  const double turned_rad = piece.profile.position(to_seconds(piece.end - piece.begin));
  const int steps = steps_for(piece.footprint.reach_m() * turned_rad * turned_rad / 8.0);
  const auto body_at = [&](int step) {
    const double angle_rad = std::copysign(turned_rad * step / steps, piece.turn_rad);
    return placed(piece.footprint, {piece.start.position_m, rotated(piece.start.heading, unit_vector(angle_rad))});
  };
  for (int step = 0; step < steps; ++step) add_part(hull, body_at(step), body_at(step + 1));
}

double to_side_m(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 side = b - a;
  const double share = std::clamp((p - a).dot(side) / side.squaredNorm(), 0.0, 1.0);
  return (p - a - share * side).norm();
}

// Whether a side of `one` parts the two.
bool has_parting_side(const Polygon& one, const Polygon& other) {
  for (std::size_t i = 0; i < one.size(); ++i) {
    const Vec2 &a = one[i], side = one[(i + 1) % one.size()] - a;
    if (std::ranges::all_of(other, [&](const Vec2& p) { return cross(side, p - a) < 0.0; })) return true;
  }
  return false;
}

double corners_to_sides_m(const Polygon& one, const Polygon& other) {
  double least_m = std::numeric_limits<double>::infinity();
  for (const Vec2& p : one) {
    for (std::size_t i = 0; i < other.size(); ++i)
      least_m = std::min(least_m, to_side_m(p, other[i], other[(i + 1) % other.size()]));
  }
  return least_m;
}

bool are_within(const Polygon& one, const Polygon& other, double distance_m) {
  if (!has_parting_side(one, other) && !has_parting_side(other, one)) return true;
  return std::min(corners_to_sides_m(one, other), corners_to_sides_m(other, one)) < distance_m;
}

}  // namespace

Hull hull_of(const Piece& piece) {
  Hull hull;
  if (piece.manner == Manner::Drive) add_drive(hull, piece);
  if (piece.manner == Manner::Turn) add_turn(hull, piece);
  if (hull.parts.empty()) add_part(hull, piece.body_at(piece.begin), piece.body_at(piece.begin));
  return hull;
}

Hull hull_of(const OrientedRectangle& body) {
  Hull hull;
  add_part(hull, body, body);
  return hull;
}

bool are_within(const Hull& one, const Hull& other, double distance_m) {
  if (!one.box.grown(distance_m).overlaps(other.box)) return false;
  return std::ranges::any_of(one.parts, [&](const Polygon& mine) {
    return std::ranges::any_of(other.parts,
                               [&](const Polygon& theirs) { return are_within(mine, theirs, distance_m); });
  });
}

}  // namespace fleetproof
