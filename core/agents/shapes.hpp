#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::agents {

struct Vec {
  double x = 0.0, y = 0.0;
  friend Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y}; }
  friend Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y}; }
  friend Vec operator*(Vec a, double k) { return {a.x * k, a.y * k}; }
};

// Headings whose cosine is larger need no turn on the spot: of 1.41 mrad.
inline constexpr double kCosineOfSameHeading = 1.0 - 1e-6;

inline double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y; }
inline Vec left_of(Vec v) { return {-v.y, v.x}; }
inline double length(Vec v) { return std::sqrt(dot(v, v)); }

// `v` turned left. Uses polynomials of its own, because the results of libm differ between processors.
Vec turned(Vec v, double angle_rad);

// The pose at the end of the arc.
fp_pose end_of(const fp_arc& arc);

// A rectangle, widened by a radius on all sides. With radius 0 it is a rectangle, without extent a disc.
struct Shape {
  Vec centre_m;
  Vec axis{1.0, 0.0};  // unit vector along the length
  double half_length_m = 0.0, half_width_m = 0.0;
  double radius_m = 0.0;

  // The radius of a disc around the centre that contains the shape.
  double reach_m() const { return std::sqrt(half_length_m * half_length_m + half_width_m * half_width_m) + radius_m; }
};

// Seen from above. The centre lies `ahead_m` ahead of the reference point.
struct Body {
  double length_m = 0.0, width_m = 0.0, ahead_m = 0.0;

  // From the reference point to the farthest corner.
  double reach_m() const { return length(Vec{length_m / 2.0 + std::abs(ahead_m), width_m / 2.0}); }
  friend bool operator==(const Body&, const Body&) = default;
};

// `at_m`: of the reference point.
Shape body_at(Vec at_m, Vec heading, const Body& body);
Shape disc_at(Vec centre_m, double radius_m);

// True if the distance between the two shapes is less than `distance_m`.
bool closer_than(const Shape& a, const Shape& b, double distance_m);

// Appends shapes that together cover the floor that a body sweeps while its reference point moves along `arc`, nose
// first or tail first. Exact for a straight line; too large by a few centimetres in bends.
void append_sweep(const fp_arc& arc, bool tail_first, const Body& body, std::vector<Shape>& shapes);

// Appends shapes that together cover the floor that a body sweeps while it turns on the spot, about its reference
// point and by the shorter way, between these headings or others that count as the same. Too large by up to a twentieth
// of the reach; at most kMostTurnPieces. Requires: the headings are at most three eighths of a full turn apart.
inline constexpr std::size_t kMostTurnPieces = 32;
void append_turn(Vec at_m, Vec from, Vec to, const Body& body, std::vector<Shape>& shapes);

}  // namespace fleetproof::agents
