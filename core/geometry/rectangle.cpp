#include "core/geometry/rectangle.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "core/base/tolerances.hpp"

namespace fleetproof {
namespace {

// Two numbers at once: the one about the second rectangle seen from the first's frame, and the one about the first seen
// from the second's. (A vector type of g++ and clang, on every processor.) There are no branches, because mispredicted
// branches would cost more than the arithmetic.
using Both [[gnu::vector_size(16)]] = double;

inline Both larger(Both a, Both b) { return a > b ? a : b; }
inline Both smaller(Both a, Both b) { return a < b ? a : b; }
inline Both magnitude(Both a) { return larger(a, -a); }

// Two rectangles, each seen from the other's frame.
struct MutualView {
  Both x, y;                // centre of the other
  Both length_x, length_y;  // half length of the other, turned into the frame
  Both width_x, width_y;    // half width of the other, turned into the frame
  Both half_length, half_width;
  Both gap_x, gap_y;  // between the shadows of both on the side directions of the frame

  MutualView(const OrientedRectangle& first, const OrientedRectangle& second) {
    const double ux = first.heading.x(), uy = first.heading.y(), vx = second.heading.x(), vy = second.heading.y();
    const double dx = second.centre_m.x() - first.centre_m.x(), dy = second.centre_m.y() - first.centre_m.y();
    const Both hx = {ux, vx}, hy = {uy, vy}, ox = {dx, -dx}, oy = {dy, -dy};
    const double c = ux * vx + uy * vy, s = ux * vy - uy * vx;
    const Both cosine = {c, c}, sine = {s, -s};
    x = ox * hx + oy * hy;
    y = oy * hx - ox * hy;
    half_length = Both{first.half_length_m, second.half_length_m};
    half_width = Both{first.half_width_m, second.half_width_m};
    const Both length = {second.half_length_m, first.half_length_m}, width = {second.half_width_m, first.half_width_m};
    length_x = cosine * length;
    length_y = sine * length;
    width_x = -sine * width;
    width_y = cosine * width;
    gap_x = magnitude(x) - (half_length + (magnitude(length_x) + magnitude(width_x)));
    gap_y = magnitude(y) - (half_width + (magnitude(length_y) + magnitude(width_y)));
  }

  double largest_gap_m() const {
    const Both gap = larger(gap_x, gap_y);
    return std::max(gap[0], gap[1]);
  }
};

// From the nearest point of the rectangle that owns the frame to a corner of the other rectangle.
struct CornerOffset {
  Both x, y, squared;
};

inline CornerOffset corner_offset(const MutualView& view, Both corner_x, Both corner_y) {
  const Both x = corner_x - smaller(larger(corner_x, -view.half_length), view.half_length);
  const Both y = corner_y - smaller(larger(corner_y, -view.half_width), view.half_width);
  return {x, y, x * x + y * y};
}

inline CornerOffset nearer(const CornerOffset& a, const CornerOffset& b) {
  const auto second = b.squared < a.squared;
  return {second ? b.x : a.x, second ? b.y : a.y, smaller(b.squared, a.squared)};
}

// Two convex bodies apart are nearest at a corner of one of them: the nearest corner of each.
[[gnu::always_inline]] inline CornerOffset nearest_corners(const MutualView& view) {
  const Both front_x = view.x + view.length_x, front_y = view.y + view.length_y;
  const Both rear_x = view.x - view.length_x, rear_y = view.y - view.length_y;
  const CornerOffset front = nearer(corner_offset(view, front_x + view.width_x, front_y + view.width_y),
                                    corner_offset(view, front_x - view.width_x, front_y - view.width_y));
  const CornerOffset rear = nearer(corner_offset(view, rear_x + view.width_x, rear_y + view.width_y),
                                   corner_offset(view, rear_x - view.width_x, rear_y - view.width_y));
  return nearer(front, rear);
}

// The side direction with the largest gap, from the first towards the second.
Vec2 widest_axis(const MutualView& view, const OrientedRectangle& first, const OrientedRectangle& second,
                 double gap_m) {
  const Vec2 aside1 = left_of(first.heading), aside2 = left_of(second.heading);
  if (view.gap_x[0] == gap_m) return view.x[0] < 0.0 ? Vec2(-first.heading) : first.heading;
  if (view.gap_y[0] == gap_m) return view.y[0] < 0.0 ? Vec2(-aside1) : aside1;
  if (view.gap_x[1] == gap_m) return view.x[1] > 0.0 ? Vec2(-second.heading) : second.heading;
  return view.y[1] > 0.0 ? Vec2(-aside2) : aside2;
}

}  // namespace

double Footprint::reach_m() const {
  const double ahead_m = length_m + 2.0 * std::abs(centre_ahead_m);
  return 0.5 * std::sqrt(ahead_m * ahead_m + width_m * width_m);
}

OrientedRectangle placed(const Footprint& footprint, const Pose& pose) {
  const Vec2 centre_m = footprint.centre_ahead_m == 0.0
                            ? pose.position_m
                            : Vec2(pose.position_m + footprint.centre_ahead_m * pose.heading);
  return {centre_m, pose.heading, 0.5 * footprint.length_m, 0.5 * footprint.width_m};
}

OrientedRectangle widened(const OrientedRectangle& rectangle, double margin_m) {
  return {rectangle.centre_m, rectangle.heading, rectangle.half_length_m + margin_m, rectangle.half_width_m + margin_m};
}

Separation separation(const OrientedRectangle& first, const OrientedRectangle& second) {
  const MutualView view(first, second);
  const double gap_m = view.largest_gap_m();
  if (gap_m <= 0.0) return {gap_m, widest_axis(view, first, second, gap_m)};
  const CornerOffset nearest = nearest_corners(view);
  const double distance_m = std::sqrt(std::min(nearest.squared[0], nearest.squared[1]));
  // The bodies are so near that the offset consists of rounding: its direction would be noise.
  if (distance_m < kNoDirection_m) return {std::max(distance_m, gap_m), widest_axis(view, first, second, gap_m)};
  // Back to the floor's frame; in the second's frame the offset points from the second to the first.
  const Both hx = {first.heading.x(), -second.heading.x()}, hy = {first.heading.y(), -second.heading.y()};
  const Both x = nearest.x * hx - nearest.y * hy, y = nearest.x * hy + nearest.y * hx;
  const int frame = nearest.squared[1] < nearest.squared[0];
  return {distance_m, Vec2(x[frame] / distance_m, y[frame] / distance_m)};
}

double clearance_m(const OrientedRectangle& first, const OrientedRectangle& second) {
  const MutualView view(first, second);
  const double gap_m = view.largest_gap_m();
  if (gap_m <= 0.0) return gap_m;
  const CornerOffset nearest = nearest_corners(view);
  return std::max(gap_m, std::sqrt(std::min(nearest.squared[0], nearest.squared[1])));
}

void Box::add(const OrientedRectangle& rectangle) {
  const Vec2 along = rectangle.heading.cwiseAbs() * rectangle.half_length_m,
             aside = left_of(rectangle.heading).cwiseAbs() * rectangle.half_width_m;
  add(Vec2(rectangle.centre_m + (along + aside)));
  add(Vec2(rectangle.centre_m - (along + aside)));
}

}  // namespace fleetproof
