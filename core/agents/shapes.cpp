#include "core/agents/shapes.hpp"

#include <algorithm>

namespace fleetproof::agents {
namespace {

constexpr double kSmallAngle_rad = 0.25;
constexpr double kPieceAngle_rad = 0.1;  // of a bend or a turn that one rectangle covers
constexpr double kBeyond_rad = 1.5e-3;   // the true headings lie so far outside of those of a turn, at most
static_assert(1.0 - 0.49 * kBeyond_rad * kBeyond_rad < kCosineOfSameHeading,
              "a turn also covers headings that count as the same, and that messages have rounded");
constexpr double kShapeRounding_m = 1e-6;

struct Rotation {
  double cosine = 1.0, sine = 0.0;
};

// Taylor, exact to rounding for |angle| <= kSmallAngle_rad.
Rotation small_rotation(double angle_rad) {
  const double q = angle_rad * angle_rad;
  const double sine =
      angle_rad * (1.0 - q / 6.0 * (1.0 - q / 20.0 * (1.0 - q / 42.0 * (1.0 - q / 72.0 * (1.0 - q / 110.0)))));
  const double cosine =
      1.0 - q / 2.0 * (1.0 - q / 12.0 * (1.0 - q / 30.0 * (1.0 - q / 56.0 * (1.0 - q / 90.0 * (1.0 - q / 132.0)))));
  return {cosine, sine};
}

Vec apply(Rotation t, Vec v) { return {t.cosine * v.x - t.sine * v.y, t.sine * v.x + t.cosine * v.y}; }

bool is_straight(const fp_arc& arc) { return std::abs(arc.curvature_per_m * arc.length_m) < 1e-9; }

// The squared distance from a point to the rectangle inside the shape.
double squared_distance(Vec point_m, const Shape& shape) {
  const Vec d = point_m - shape.centre_m;
  const double along = std::max(std::abs(dot(d, shape.axis)) - shape.half_length_m, 0.0);
  const double across = std::max(std::abs(dot(d, left_of(shape.axis))) - shape.half_width_m, 0.0);
  return along * along + across * across;
}

double smallest_corner_distance2(const Shape& corners_of, const Shape& from) {
  const Vec u = corners_of.axis * corners_of.half_length_m, v = left_of(corners_of.axis) * corners_of.half_width_m;
  const Vec c = corners_of.centre_m;
  return std::min(std::min(squared_distance(c + u + v, from), squared_distance(c + u - v, from)),
                  std::min(squared_distance(c - u + v, from), squared_distance(c - u - v, from)));
}

// The separating axes are the axes of both rectangles.
bool overlap(const Shape& a, const Shape& b) {
  const Vec d = b.centre_m - a.centre_m;
  const double c = std::abs(dot(a.axis, b.axis)), s = std::abs(dot(a.axis, left_of(b.axis)));
  return std::abs(dot(d, a.axis)) <= a.half_length_m + b.half_length_m * c + b.half_width_m * s &&
         std::abs(dot(d, left_of(a.axis))) <= a.half_width_m + b.half_length_m * s + b.half_width_m * c &&
         std::abs(dot(d, b.axis)) <= b.half_length_m + a.half_length_m * c + a.half_width_m * s &&
         std::abs(dot(d, left_of(b.axis))) <= b.half_width_m + a.half_length_m * s + a.half_width_m * c;
}

// The body with its reference point at the origin, as large as it needs to be to cover it however it is turned by up to
// `half` about that point: its sides tilt, and its centre swings.
Shape body_swung(const Body& body, Rotation half) {
  const double off_m = std::abs(body.ahead_m) * half.sine, back_m = std::abs(body.ahead_m) * (1.0 - half.cosine);
  return {{body.ahead_m, 0.0},
          {1.0, 0.0},
          body.length_m / 2.0 + body.width_m / 2.0 * half.sine + back_m + kShapeRounding_m,
          body.width_m / 2.0 + body.length_m / 2.0 * half.sine + off_m + kShapeRounding_m};
}

Vec unit(Vec v) { return v * (1.0 / length(v)); }

// Halves the angle until one rectangle covers what is between the headings.
void append_pieces(Vec at_m, Vec from, Vec to, const Body& body, std::vector<Shape>& shapes) {
  const Vec middle = unit(from + to);
  const double sine = std::abs(dot(left_of(middle), to));  // of half the angle
  if (sine > kPieceAngle_rad / 2.0) {
    append_pieces(at_m, from, middle, body, shapes);
    append_pieces(at_m, middle, to, body, shapes);
    return;
  }
  Shape swung = body_swung(body, {dot(middle, to), sine});
  swung.centre_m = at_m + middle * body.ahead_m;
  swung.axis = middle;
  shapes.push_back(swung);
}

}  // namespace

Vec turned(Vec v, double angle_rad) {
  const double steps = std::ceil(std::abs(angle_rad) / kSmallAngle_rad);
  if (steps < 1.0) return v;
  const Rotation t = small_rotation(angle_rad / steps);
  for (double i = 0.0; i < steps; i += 1.0) v = apply(t, v);
  return v;
}

fp_pose end_of(const fp_arc& arc) {
  const Vec start{arc.start.x_m, arc.start.y_m}, heading{arc.start.heading_x, arc.start.heading_y};
  if (is_straight(arc)) {
    const Vec end = start + heading * arc.length_m;
    return {end.x, end.y, heading.x, heading.y};
  }
  const Vec last = turned(heading, arc.curvature_per_m * arc.length_m);
  const Vec centre = start + left_of(heading) * (1.0 / arc.curvature_per_m);
  const Vec end = centre - left_of(last) * (1.0 / arc.curvature_per_m);
  return {end.x, end.y, last.x, last.y};
}

Shape body_at(Vec at_m, Vec heading, const Body& body) {
  return {at_m + heading * body.ahead_m, heading, body.length_m / 2.0, body.width_m / 2.0, 0.0};
}

Shape disc_at(Vec centre_m, double radius_m) { return {centre_m, {1.0, 0.0}, 0.0, 0.0, radius_m}; }

bool closer_than(const Shape& a, const Shape& b, double distance_m) {
  const Vec d = b.centre_m - a.centre_m;
  const double far = a.reach_m() + b.reach_m() + distance_m;
  if (dot(d, d) >= far * far) return false;
  if (overlap(a, b)) return true;
  // If two rectangles do not overlap, the nearest points are a corner of one and a side of the other.
  const double near = a.radius_m + b.radius_m + distance_m;
  return std::min(smallest_corner_distance2(a, b), smallest_corner_distance2(b, a)) < near * near;
}

void append_sweep(const fp_arc& arc, bool tail_first, const Body& body, std::vector<Shape>& shapes) {
  const double ahead_m = tail_first ? -body.ahead_m : body.ahead_m;  // of the travel
  Vec at{arc.start.x_m, arc.start.y_m}, heading{arc.start.heading_x, arc.start.heading_y};
  if (is_straight(arc)) {
    shapes.push_back({at + heading * (arc.length_m / 2.0 + ahead_m), heading, (arc.length_m + body.length_m) / 2.0,
                      body.width_m / 2.0, 0.0});
    return;
  }
  const double angle_rad = std::abs(arc.curvature_per_m) * arc.length_m;
  const double pieces = std::ceil(angle_rad / kPieceAngle_rad);
  const double radius_m = 1.0 / std::abs(arc.curvature_per_m);
  const double quarter_rad = angle_rad / pieces / 4.0;
  const Rotation quarter = small_rotation(arc.curvature_per_m > 0.0 ? quarter_rad : -quarter_rad);
  const Rotation half = small_rotation(2.0 * quarter_rad);
  const double half_chord_m = radius_m * half.sine, sagitta_m = radius_m * (1.0 - half.cosine);
  const Shape swung = body_swung(body, half);
  const double half_length_m = swung.half_length_m + half_chord_m, half_width_m = swung.half_width_m + sagitta_m;
  const auto advance_half = [&] {  // along the chord, which lies half-way between the two headings
    heading = apply(quarter, heading);
    at = at + heading * (2.0 * radius_m * std::abs(quarter.sine));
    heading = apply(quarter, heading);
  };
  for (double i = 0.0; i < pieces; i += 1.0) {
    advance_half();
    shapes.push_back({at + heading * ahead_m, heading, half_length_m, half_width_m, 0.0});
    advance_half();
  }
}

void append_turn(Vec at_m, Vec from, Vec to, const Body& body, std::vector<Shape>& shapes) {
  const double beyond = dot(left_of(from), to) > 0.0 ? kBeyond_rad : -kBeyond_rad;
  append_pieces(at_m, unit(from - left_of(from) * beyond), unit(to + left_of(to) * beyond), body, shapes);
}

}  // namespace fleetproof::agents
