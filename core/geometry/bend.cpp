#include "core/geometry/bend.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/base/tolerances.hpp"

namespace fleetproof {
namespace {

// A polynomial of degree N on [0, 1] in the basis of Bernstein. Its values lie between its least and its largest
// coefficient.
template <std::size_t N>
using Bernstein = std::array<double, N + 1>;

constexpr double binomial(std::size_t n, std::size_t k) {
  double result = 1.0;
  for (std::size_t i = 0; i < k; ++i) result = result * static_cast<double>(n - i) / static_cast<double>(i + 1);
  return result;
}

template <std::size_t M, std::size_t N>
constexpr std::array<std::array<double, N + 1>, M + 1> product_weights() {
  std::array<std::array<double, N + 1>, M + 1> weights{};
  for (std::size_t i = 0; i <= M; ++i) {
    for (std::size_t j = 0; j <= N; ++j) weights[i][j] = binomial(M, i) * binomial(N, j) / binomial(M + N, i + j);
  }
  return weights;
}

template <std::size_t A, std::size_t B>
std::array<double, A + B - 1> product(const std::array<double, A>& p, const std::array<double, B>& q) {
  static constexpr auto kWeights = product_weights<A - 1, B - 1>();
  std::array<double, A + B - 1> result{};
  for (std::size_t i = 0; i < A; ++i) {
    for (std::size_t j = 0; j < B; ++j) result[i + j] += kWeights[i][j] * p[i] * q[j];
  }
  return result;
}

template <std::size_t A>
std::array<double, A - 1> derivative(const std::array<double, A>& p) {
  std::array<double, A - 1> result{};
  for (std::size_t i = 0; i + 1 < A; ++i) result[i] = static_cast<double>(A - 1) * (p[i + 1] - p[i]);
  return result;
}

// p + factor * q.
template <std::size_t A>
std::array<double, A> sum(const std::array<double, A>& p, double factor, const std::array<double, A>& q) {
  std::array<double, A> result{};
  for (std::size_t i = 0; i < A; ++i) result[i] = p[i] + factor * q[i];
  return result;
}

// No value on [0, 1] is farther from zero.
template <std::size_t A>
double most_of(const std::array<double, A>& p) {
  double most = 0.0;
  for (const double c : p) most = std::max(most, c < 0.0 ? -c : c);
  return most;
}

// The points and weights of Gauss and Legendre on [-1, 1], by pairs.
struct GaussPoint {
  double at, weight;
};
constexpr std::array<GaussPoint, 4> kGauss{{{0.1834346424956498049, 0.3626837833783619830},
                                            {0.5255324099163289858, 0.3137066458778872873},
                                            {0.7966664774136267396, 0.2223810344533744706},
                                            {0.9602898564975362317, 0.1012285362903762592}}};

double arc_length_m(const Cubic& cubic, double from, double to) {
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  double sum = 0.0;
  for (const auto& [at, weight] : kGauss) {
    sum += weight * (cubic.velocity(middle - half * at).norm() + cubic.velocity(middle + half * at).norm());
  }
  return half * sum;
}

// The parameter's first three derivatives by the arc length.
std::array<double, 3> by_arc_length(const Cubic& cubic, double u) {
  const Vec2 v = cubic.velocity(u), a = cubic.acceleration(u);
  const double g = v.squaredNorm(), g1 = 2.0 * v.dot(a), g2 = 2.0 * (a.squaredNorm() + v.dot(6.0 * cubic.c));
  return {1.0 / std::sqrt(g), -0.5 * g1 / (g * g), (g1 * g1 / g - 0.5 * g2) / (g * g * std::sqrt(g))};
}

// The polynomial of degree 7 with these values and first three derivatives at 0 and at 1; its value at 0 is 0.
std::array<double, 8> hermite(const std::array<double, 3>& begin, double end, const std::array<double, 3>& at_end) {
  const double c1 = begin[0], c2 = begin[1] / 2.0, c3 = begin[2] / 6.0;
  const double r0 = end - (c1 + c2 + c3), r1 = at_end[0] - (c1 + 2.0 * c2 + 3.0 * c3),
               r2 = at_end[1] - (2.0 * c2 + 6.0 * c3), r3 = at_end[2] - 6.0 * c3;
  return {0.0,
          c1,
          c2,
          c3,
          35.0 * r0 - 15.0 * r1 + 2.5 * r2 - r3 / 6.0,
          -84.0 * r0 + 39.0 * r1 - 7.0 * r2 + 0.5 * r3,
          70.0 * r0 - 34.0 * r1 + 6.5 * r2 - 0.5 * r3,
          -20.0 * r0 + 10.0 * r1 - 2.0 * r2 + r3 / 6.0};
}

// Bounds on curvature, and on its first two derivatives by arc length, between two parameters: quotients of polynomials
// in Bernstein's basis. Nothing if the curve may stand still there.
//
// With g = v.v and n = v x a, the curvature is n / g^(3/2). Its derivative by the parameter, divided by sqrt(g), is
// m / g^3 with m = n' g - 3/2 n g'; in the same way, the next one is (m' g - 3 m g') / g^(9/2).
std::optional<MostBending> most_between(const Cubic& cubic, double from, double to) {
  const double width = to - from;
  const Vec2 v0 = width * cubic.velocity(from), v2 = width * cubic.velocity(to),
             v1 = width * (cubic.a + cubic.b * (from + to) + 3.0 * from * to * cubic.c);
  const Bernstein<2> x{v0.x(), v1.x(), v2.x()}, y{v0.y(), v1.y(), v2.y()};
  const auto g = sum(product(x, x), 1.0, product(y, y));
  const double least = *std::ranges::min_element(g);
  if (!(least > 0.0)) return std::nullopt;
  const auto n = sum(product(x, derivative(y)), -1.0, product(derivative(x), y));
  const auto m = sum(product(derivative(n), g), -1.5, product(n, derivative(g)));
  const auto q = sum(product(derivative(m), g), -3.0, product(m, derivative(g)));
  const double root = std::sqrt(least), cube = least * least * least;
  return MostBending{most_of(n) / (least * root), most_of(m) / cube, most_of(q) / (cube * least * root)};
}

}  // namespace

Cubic Cubic::bezier(const std::array<Vec2, 4>& p) {
  const Vec2 a = p[1] - p[0], b = p[2] - p[1], c = p[3] - p[2];
  return {p[0], 3.0 * a, 3.0 * (b - a), (c - b) - (b - a)};
}

std::array<Vec2, 4> Cubic::control_points_m(double from, double to) const {
  const double third = (to - from) / 3.0;
  const auto relative = [&](double u) { return Vec2(u * (a + u * (b + u * c))); };
  return {relative(from), relative(from) + third * velocity(from), relative(to) - third * velocity(to), relative(to)};
}

std::optional<Bend> Bend::of(const Cubic& cubic, double from, double to) {
  Bend bend;
  bend.cubic_ = cubic;
  bend.from_ = from;
  if (!bend.measure(to) || !bend.bound(to)) return std::nullopt;
  return bend;
}

bool Bend::bound(double to) {
  constexpr int kParts = 4;  // the bounds of a short part are nearer to the truth
  for (int i = 0; i < kParts; ++i) {
    const double step = (to - from_) / kParts;
    const auto most = most_between(cubic_, from_ + step * i, i + 1 < kParts ? from_ + step * (i + 1) : to);
    if (!most) return false;
    most_.per_m = std::max(most_.per_m, most->per_m);
    most_.per_m2 = std::max(most_.per_m2, most->per_m2);
    most_.per_m3 = std::max(most_.per_m3, most->per_m3);
  }
  return true;
}

bool Bend::measure(double to) {
  constexpr double kMost = 0.5 * kAlongCurve_m;
  length_m_ = arc_length_m(cubic_, from_, to);
  std::array<double, 3> begin = by_arc_length(cubic_, from_), end = by_arc_length(cubic_, to);
  double power = 1.0;
  for (std::size_t i = 0; i < 3; ++i) {
    power *= length_m_;
    begin[i] *= power;
    end[i] *= power;
  }
  parameter_ = hermite(begin, to - from_, end);
  // The error of the polynomial is largest in the middle, unless it changes its sign there; then it is largest nearby.
  // The three parts also check the length.
  constexpr double kFirst = 0.4, kSecond = 0.6;
  const double first = parameter_at(kFirst * length_m_), second = parameter_at(kSecond * length_m_);
  if (!(first > from_ && second > first && second < to)) return false;
  const double first_m = arc_length_m(cubic_, from_, first), rest_m = arc_length_m(cubic_, second, to);
  const double whole_m = first_m + arc_length_m(cubic_, first, second) + rest_m;
  return std::abs(first_m - kFirst * length_m_) < kMost && std::abs(rest_m - (1.0 - kSecond) * length_m_) < kMost &&
         std::abs(whole_m - length_m_) < kMost;
}

double Bend::parameter_at(double s_m) const {
  const double x = reversed_ ? 1.0 - s_m / length_m_ : s_m / length_m_;
  double value = parameter_[7];
  for (std::size_t i = 7; i > 0; --i) value = value * x + parameter_[i - 1];
  return from_ + value;
}

Pose Bend::pose_at(double s_m) const {
  const double u = parameter_at(s_m);
  const Vec2 velocity = cubic_.velocity(u);
  return {cubic_.point_m(u), velocity / (reversed_ ? -velocity.norm() : velocity.norm())};
}

Bending Bend::bending_at(double s_m) const {
  const double u = parameter_at(s_m);
  const Vec2 v = cubic_.velocity(u), a = cubic_.acceleration(u);
  const double g = v.squaredNorm(), n = cross(v, a);
  const double per_m = n / (g * std::sqrt(g)),
               per_m2 = (cross(v, 6.0 * cubic_.c) * g - 3.0 * n * v.dot(a)) / (g * g * g);
  return {reversed_ ? -per_m : per_m, per_m2};
}

Bend Bend::reversed() const {
  Bend other = *this;
  other.reversed_ = !reversed_;
  return other;
}

Bend Bend::moved(const Vec2& by_m) const {
  Bend other = *this;
  other.cubic_.origin_m += by_m;
  return other;
}

}  // namespace fleetproof
