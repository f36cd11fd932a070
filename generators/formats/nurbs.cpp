#include "generators/formats/nurbs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/tolerances.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kHighestDegree = 9, kMostPoints = 10'000;
constexpr int kStepsPerSpan = 16;

bool equal_weights(const Nurbs& n) {
  return std::ranges::all_of(n.weights, [&](double w) { return w == n.weights[0]; });
}

// Whether the knots cut the curve into Bezier pieces: degree + 1 equal ones at both ends, degree equal ones at each
// joint.
bool in_bezier_form(const Nurbs& n) {
  const auto d = n.degree;
  if ((n.points_m.size() - 1) % d != 0) return false;
  if (n.knots[0] != n.knots[1] || n.knots.back() != n.knots[n.knots.size() - 2]) return false;
  for (std::size_t first = 1; first + d <= n.knots.size() - 1; first += d) {
    if (n.knots[first] != n.knots[first + d - 1] || (first > 1 && n.knots[first] == n.knots[first - 1])) return false;
  }
  return true;
}

std::vector<Vec2> raised_from_quadratic(const std::vector<Vec2>& p) {
  std::vector<Vec2> cubic{p[0]};
  for (std::size_t i = 0; i + 2 < p.size(); i += 2) {
    cubic.push_back(p[i] + (p[i + 1] - p[i]) * (2.0 / 3.0));
    cubic.push_back(p[i + 2] + (p[i + 1] - p[i + 2]) * (2.0 / 3.0));
    cubic.push_back(p[i + 2]);
  }
  return cubic;
}

bool is_straight(const std::vector<Vec2>& p) {
  const Vec2 way = p.back() - p[0];
  const double length = way.norm();
  if (length < kNurbsPoint_m) return false;
  double reached = 0.0;
  for (const auto& point : p) {
    const Vec2 to = point - p[0];
    const double along = to.dot(way) / length;
    if (std::abs(to.x() * way.y() - to.y() * way.x()) > kNurbsPoint_m * length || along < reached - kNurbsPoint_m)
      return false;
    reached = along;
  }
  return true;
}

// De Boor's algorithm on (w x, w y, w), within the span of knots that begins at index `span`.
Vec2 point_at(const Nurbs& n, std::size_t span, double u) {
  const auto d = n.degree;
  std::vector<Vec2> points(d + 1);
  std::vector<double> weights(d + 1);
  for (std::size_t i = 0; i <= d; ++i) {
    weights[i] = n.weights[span - d + i];
    points[i] = n.points_m[span - d + i] * weights[i];
  }
  for (std::size_t round = 1; round <= d; ++round) {
    for (std::size_t i = d; i >= round; --i) {
      const double low = n.knots[span - d + i], high = n.knots[span + i + 1 - round];
      const double share = (u - low) / (high - low);
      points[i] = points[i - 1] * (1.0 - share) + points[i] * share;
      weights[i] = weights[i - 1] * (1.0 - share) + weights[i] * share;
    }
  }
  return points[d] / weights[d];
}

std::vector<Vec2> points_along(const Nurbs& n) {
  std::vector<Vec2> points;
  const auto add = [&](const Vec2& point) {
    if (points.empty() || (point - points.back()).norm() > kNurbsPoint_m) points.push_back(point);
  };
  const int steps = n.degree == 1 ? 1 : kStepsPerSpan;
  for (std::size_t span = n.degree; span < n.points_m.size(); ++span) {
    const double low = n.knots[span], high = n.knots[span + 1];
    if (!(low < high)) continue;
    for (int k = 0; k <= steps; ++k) add(point_at(n, span, low + (high - low) * k / steps));
  }
  return points;
}

// Cubic pieces through points. At each inner point, the curve is parallel to the line between the neighbours of the
// point. At the two outermost points, it has the direction of a circle.
std::vector<Vec2> smooth_through(const std::vector<Vec2>& p) {
  std::vector<Vec2> tangents(p.size());
  for (std::size_t i = 1; i + 1 < p.size(); ++i) {
    const Vec2 across = p[i + 1] - p[i - 1];
    tangents[i] = across.norm() > kNurbsPoint_m ? across.normalized() : (p[i + 1] - p[i]).normalized();
  }
  const auto mirrored = [](const Vec2& tangent, const Vec2& chord) {
    const Vec2 c = chord.normalized();
    return Vec2(c * (2.0 * c.dot(tangent)) - tangent);
  };
  tangents.front() = mirrored(tangents[1], p[1] - p[0]);
  tangents.back() = mirrored(tangents[p.size() - 2], p.back() - p[p.size() - 2]);
  std::vector<Vec2> control_points;
  for (std::size_t i = 0; i + 1 < p.size(); ++i) {
    const double third = (p[i + 1] - p[i]).norm() / 3.0;
    if (i > 0) control_points.push_back(p[i]);
    control_points.push_back(p[i] + tangents[i] * third);
    control_points.push_back(p[i + 1] - tangents[i + 1] * third);
  }
  return control_points;
}

}  // namespace

std::string fault_of(const Nurbs& n) {
  if (n.degree < 1 || n.degree > kHighestDegree)
    return fmt::format("degree {} is not between 1 and {}", n.degree, kHighestDegree);
  if (n.points_m.size() <= n.degree)
    return fmt::format("degree {} needs at least {} control points; here are {}", n.degree, n.degree + 1,
                       n.points_m.size());
  if (n.points_m.size() > kMostPoints) return fmt::format("more than {} control points; split the edge", kMostPoints);
  if (n.knots.size() != n.points_m.size() + n.degree + 1) {
    return fmt::format("{} control points of degree {} need {} knots; here are {}", n.points_m.size(), n.degree,
                       n.points_m.size() + n.degree + 1, n.knots.size());
  }
  if (!std::ranges::is_sorted(n.knots)) return "the knots do not ascend; put them in order";
  if (!(n.knots[n.degree] < n.knots[n.points_m.size()])) return "all knots are equal; they run from 0 to 1";
  for (const double weight : n.weights) {
    if (!(weight > 0.0)) return fmt::format("weight {} is not positive", weight);
  }
  return "";
}

CubicPieces cubic_pieces(const Nurbs& n) {
  CubicPieces pieces;
  if (n.degree <= 3 && in_bezier_form(n) && equal_weights(n)) {
    pieces.begin_m = n.points_m.front();
    pieces.end_m = n.points_m.back();
    if (n.degree == 1 && (n.points_m.size() == 2 || is_straight(n.points_m))) return pieces;
    if (n.degree > 1) {
      const auto cubic = n.degree == 2 ? raised_from_quadratic(n.points_m) : n.points_m;
      pieces.control_points_m.assign(cubic.begin() + 1, cubic.end() - 1);
      return pieces;
    }
  }
  const auto points = points_along(n);
  pieces.exact = false;
  pieces.begin_m = points.front();
  pieces.end_m = points.back();
  if (points.size() > 2) pieces.control_points_m = smooth_through(points);
  return pieces;
}

}  // namespace fleetproof
