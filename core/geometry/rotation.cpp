#include "core/geometry/rotation.hpp"

#include <cmath>

#include "core/base/tolerances.hpp"

namespace fleetproof {
namespace {

// pi/2 = kHalfPiHigh + kHalfPiLow to 2^-86 or so. The high part has 33 bits, so that its products with the quadrant
// numbers up to 6367 are exact.
constexpr double kHalfPiHigh = 1.57079632673412561417e+00;
constexpr double kHalfPiLow = 6.07710050650619224932e-11;

// Taylor series on [-pi/4, pi/4]: the first terms left out are below 1e-17.
double small_sine(double r) {
  const double z = r * r;
  double sum = 1.0 / 355687428096000.0;
  sum = -1.0 / 1307674368000.0 + z * sum;
  sum = 1.0 / 6227020800.0 + z * sum;
  sum = -1.0 / 39916800.0 + z * sum;
  sum = 1.0 / 362880.0 + z * sum;
  sum = -1.0 / 5040.0 + z * sum;
  sum = 1.0 / 120.0 + z * sum;
  sum = -1.0 / 6.0 + z * sum;
  return r + r * (z * sum);
}

double small_cosine(double r) {
  const double z = r * r;
  double sum = 1.0 / 20922789888000.0;
  sum = -1.0 / 87178291200.0 + z * sum;
  sum = 1.0 / 479001600.0 + z * sum;
  sum = -1.0 / 3628800.0 + z * sum;
  sum = 1.0 / 40320.0 + z * sum;
  sum = -1.0 / 720.0 + z * sum;
  sum = 1.0 / 24.0 + z * sum;
  return 1.0 - (0.5 * z - z * (z * sum));
}

// atan on [0, 1] to 1e-4 or better (Hastings' polynomial). It is the start for two Newton steps: the first makes the
// error less than 1e-12, the second makes it less than rounding.
double rough_arctangent(double t) {
  const double z = t * t;
  return t * (0.9998660 + z * (-0.3302995 + z * (0.1801410 + z * (-0.0851330 + z * 0.0208351))));
}

}  // namespace

Vec2 unit_vector(double angle_rad) {
  const int quadrant = static_cast<int>(angle_rad * (2.0 / kPi) + (angle_rad < 0.0 ? -0.5 : 0.5));
  const double r = (angle_rad - quadrant * kHalfPiHigh) - quadrant * kHalfPiLow;
  const double s = small_sine(r), c = small_cosine(r);
  switch (quadrant & 3) {
    case 0:
      return {c, s};
    case 1:
      return {-s, c};
    case 2:
      return {-c, -s};
    default:
      return {s, -c};
  }
}

double angle_between(const Vec2& from, const Vec2& to) {
  const double s = cross(from, to), c = from.dot(to);
  const double norm = std::sqrt(s * s + c * c);
  if (!(norm > 0.0)) return 0.0;
  const double opposite = std::abs(s) / norm, adjacent = std::abs(c) / norm;
  const bool steep = opposite > adjacent;
  const double low = steep ? adjacent : opposite, high = steep ? opposite : adjacent;
  double angle = rough_arctangent(low / high);
  for (int i = 0; i < 2; ++i) {
    const Vec2 guess = unit_vector(angle);
    angle += low * guess.x() - high * guess.y();
  }
  if (steep) angle = 0.5 * kPi - angle;
  if (c < 0.0) angle = kPi - angle;
  // Headings that are opposite but for rounding turn left, whichever way the last bit points.
  const bool left = s >= 0.0 || (c < 0.0 && opposite < kOpposite);
  return left ? angle : -angle;
}

}  // namespace fleetproof
