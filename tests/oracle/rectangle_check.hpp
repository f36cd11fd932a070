#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "core/geometry/rectangle.hpp"
#include "core/geometry/rotation.hpp"

// The distance of two rectangles against corners, sides and long doubles.
namespace fleetproof::test {

// An oracle that shares nothing with the kernel: corners, sides and long doubles.
struct LongPoint {
  long double x, y;
};
using LongRectangle = std::array<LongPoint, 4>;

inline LongRectangle corners_of(const OrientedRectangle& r) {
  const long double hx = r.heading.x(), hy = r.heading.y(), l = r.half_length_m, w = r.half_width_m,
                    cx = r.centre_m.x(), cy = r.centre_m.y();
  const auto at = [&](long double a, long double b) { return LongPoint{cx + a * hx - b * hy, cy + a * hy + b * hx}; };
  return {at(l, w), at(-l, w), at(-l, -w), at(l, -w)};
}

inline long double area(const LongPoint& a, const LongPoint& b, const LongPoint& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

inline long double distance_to_side(const LongPoint& p, const LongPoint& a, const LongPoint& b) {
  const long double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
  const long double t = square > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / square, 0.0L, 1.0L) : 0.0L;
  return std::sqrt((p.x - a.x - t * dx) * (p.x - a.x - t * dx) + (p.y - a.y - t * dy) * (p.y - a.y - t * dy));
}

inline bool contains(const LongRectangle& r, const LongPoint& p) {
  for (std::size_t i = 0; i < 4; ++i) {
    if (area(r[i], r[(i + 1) % 4], p) < 0) return false;
  }
  return true;
}

inline bool sides_cross(const LongPoint& a, const LongPoint& b, const LongPoint& c, const LongPoint& d) {
  return area(a, b, c) * area(a, b, d) < 0 && area(c, d, a) * area(c, d, b) < 0;
}

// Distance between the outlines, negative if the rectangles share a point.
inline long double oracle_m(const OrientedRectangle& first, const OrientedRectangle& second) {
  const LongRectangle a = corners_of(first), b = corners_of(second);
  long double least = 1e30L;
  bool meet = false;
  for (std::size_t i = 0; i < 4; ++i) {
    meet = meet || contains(a, b[i]) || contains(b, a[i]);
    for (std::size_t j = 0; j < 4; ++j) {
      least =
          std::min({least, distance_to_side(a[i], b[j], b[(j + 1) % 4]), distance_to_side(b[i], a[j], a[(j + 1) % 4])});
      meet = meet || sides_cross(a[i], a[(i + 1) % 4], b[j], b[(j + 1) % 4]);
    }
  }
  return meet ? -least : least;
}

// Corner i = 0..3, counter-clockwise from front left.
inline Vec2 corner_of(const OrientedRectangle& r, int i) {
  const double along = i == 0 || i == 3 ? r.half_length_m : -r.half_length_m;
  const double aside = i < 2 ? r.half_width_m : -r.half_width_m;
  return r.centre_m + along * r.heading + aside * left_of(r.heading);
}

inline double extent_m(const OrientedRectangle& r, const Vec2& direction) {
  double most = -1e300;
  for (int i = 0; i < 4; ++i) most = std::max(most, direction.dot(corner_of(r, i)));
  return most;
}

class Random {
 public:
  double in(double low, double high) {
    return low + (high - low) * std::uniform_real_distribution<double>(0.0, 1.0)(engine_);
  }
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
  OrientedRectangle anywhere(double range_m) {
    return {{in(0, range_m), in(0, range_m)}, unit_vector(in(-kPi, kPi)), in(0.05, 1.5), in(0.05, 1.5)};
  }
  // Parallel, `gap_m` beside each other.
  std::array<OrientedRectangle, 2> beside(double range_m, double gap_m) {
    OrientedRectangle a = anywhere(range_m), b = anywhere(1.0);
    b.heading = a.heading;
    const double aside = a.half_width_m + b.half_width_m + gap_m,
                 along = in(-1.0, 1.0) * (a.half_length_m + b.half_length_m);
    b.centre_m = a.centre_m + along * a.heading + aside * left_of(a.heading);
    return {a, b};
  }
  OrientedRectangle on_lattice() {
    return {{0.25 * whole(0, 20), 0.25 * whole(0, 20)},
            unit_vector(0.25 * kPi * whole(-4, 4)),
            0.25 * whole(1, 5),
            0.25 * whole(1, 5)};
  }

 private:
  std::mt19937_64 engine_{20240601};
};

// Clearance, sign and direction of one pair against the oracle.
inline void check_pair(const OrientedRectangle& a, const OrientedRectangle& b) {
  const auto truth = static_cast<double>(oracle_m(a, b));
  const Separation apart = separation(a, b);
  ASSERT_NEAR(apart.direction.norm(), 1.0, 1e-12);
  ASSERT_NEAR(clearance_m(a, b), apart.clearance_m, 1e-13);
  ASSERT_NEAR(separation(b, a).clearance_m, apart.clearance_m, 1e-13);
  // The gap along the direction is the clearance itself, or the depth.
  ASSERT_NEAR(-extent_m(b, -apart.direction) - extent_m(a, apart.direction), apart.clearance_m, 1e-11);
  // Closer to a touch than that, rounding of the corners decides what they do.
  if (std::abs(truth) > 1e-12) {
    ASSERT_EQ(apart.clearance_m > 0.0, truth > 0.0);
  }
  if (truth > 0.0) {
    ASSERT_NEAR(apart.clearance_m, truth, 1e-12);
  } else {
    ASSERT_LT(apart.clearance_m, 1e-12);
    ASSERT_LE(-truth, -apart.clearance_m + 1e-12);
  }
}

}  // namespace fleetproof::test
