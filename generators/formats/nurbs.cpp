#include "generators/formats/nurbs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/tolerances.hpp"
#include "generators/formats/rounded_way.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kHighestDegree = 9, kMostCurvePoints = 10'000;

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

// A place on a curve, and its change with the parameter.
struct CurvePoint {
  Vec2 point_m, velocity;
};

// De Boor's algorithm on (w x, w y, w), within the span of knots that begins at index `span`. The last round also gives
// the derivative.
CurvePoint place_at(const Nurbs& n, std::size_t span, double u) {
  const auto d = n.degree;
  std::vector<Vec2> points(d + 1);
  std::vector<double> weights(d + 1);
  for (std::size_t i = 0; i <= d; ++i) {
    weights[i] = n.weights[span - d + i];
    points[i] = n.points_m[span - d + i] * weights[i];
  }
  Vec2 points_rate = Vec2::Zero();
  double weights_rate = 0.0;
  for (std::size_t round = 1; round <= d; ++round) {
    for (std::size_t i = d; i >= round; --i) {
      const double low = n.knots[span - d + i], high = n.knots[span + i + 1 - round];
      const double share = (u - low) / (high - low);
      if (round == d) {
        points_rate = (points[i] - points[i - 1]) * (static_cast<double>(d) / (high - low));
        weights_rate = (weights[i] - weights[i - 1]) * (static_cast<double>(d) / (high - low));
      }
      points[i] = points[i - 1] * (1.0 - share) + points[i] * share;
      weights[i] = weights[i - 1] * (1.0 - share) + weights[i] * share;
    }
  }
  const Vec2 point_m = points[d] / weights[d];
  return {point_m, (points_rate - weights_rate * point_m) / weights[d]};
}

// The cubic piece between two parameters of a span, by the places and velocities at its ends.
struct CubicPiece {
  Vec2 begin_m, first_m, second_m, end_m;

  CubicPiece(const CurvePoint& from, const CurvePoint& to, double width)
      : begin_m(from.point_m),
        first_m(from.point_m + from.velocity * (width / 3.0)),
        second_m(to.point_m - to.velocity * (width / 3.0)),
        end_m(to.point_m) {}
  Vec2 point_m(double t) const {
    const double u = 1.0 - t;
    return u * u * u * begin_m + 3.0 * u * t * (u * first_m + t * second_m) + t * t * t * end_m;
  }
  Vec2 velocity(double t) const {
    const double u = 1.0 - t;
    return 3.0 * (u * u * (first_m - begin_m) + 2.0 * u * t * (second_m - first_m) + t * t * (end_m - second_m));
  }
};

// Adds the pieces of a span, halved until they are near the curve in place and heading.
void add_pieces(const Nurbs& n, const NearCurve& most, std::size_t span, double low, double high, int halves_left,
                std::vector<CubicPiece>& pieces) {
  const CurvePoint from = place_at(n, span, low), to = place_at(n, span, high);
  const CubicPiece piece(from, to, high - low);
  bool near = true;
  for (const double t : {0.25, 0.5, 0.75}) {
    const CurvePoint place = place_at(n, span, low + (high - low) * t);
    const Vec2 along = piece.velocity(t).stableNormalized(), truth = place.velocity.stableNormalized();
    near = near && (piece.point_m(t) - place.point_m).norm() < most.m && (along - truth).norm() < most.rad;
  }
  if (near || halves_left == 0) {
    if ((to.point_m - from.point_m).norm() > kNurbsPoint_m) pieces.push_back(piece);
    return;
  }
  const double middle = 0.5 * (low + high);
  add_pieces(n, most, span, low, middle, halves_left - 1, pieces);
  add_pieces(n, most, span, middle, high, halves_left - 1, pieces);
}

// Where two pieces meet, they take the direction between their own, so that rounding makes no kink. Corners remain.
void smooth_joints(std::vector<CubicPiece>& pieces) {
  for (std::size_t i = 0; i + 1 < pieces.size(); ++i) {
    const Vec2 joint = 0.5 * (pieces[i].end_m + pieces[i + 1].begin_m);
    const Vec2 in = joint - pieces[i].second_m, out = pieces[i + 1].first_m - joint;
    pieces[i].end_m = pieces[i + 1].begin_m = joint;
    const Vec2 along = (in.stableNormalized() + out.stableNormalized()).stableNormalized();
    if ((in.stableNormalized() - out.stableNormalized()).norm() > kSmoothedKink_rad) continue;
    pieces[i].second_m = joint - in.norm() * along;
    pieces[i + 1].first_m = joint + out.norm() * along;
  }
}

std::vector<CubicPiece> pieces_along(const Nurbs& n, const NearCurve& most) {
  constexpr int kMostHalves = 8;
  std::vector<CubicPiece> pieces;
  for (std::size_t span = n.degree; span < n.points_m.size(); ++span) {
    if (n.knots[span] < n.knots[span + 1])
      add_pieces(n, most, span, n.knots[span], n.knots[span + 1], kMostHalves, pieces);
  }
  smooth_joints(pieces);
  return pieces;
}

}  // namespace

std::string fault_of(const Nurbs& n) {
  if (n.degree < 1 || n.degree > kHighestDegree)
    return fmt::format("degree {} is not between 1 and {}", n.degree, kHighestDegree);
  if (n.points_m.size() <= n.degree)
    return fmt::format("degree {} needs at least {} control points; here are {}", n.degree, n.degree + 1,
                       n.points_m.size());
  if (n.points_m.size() > kMostCurvePoints)
    return fmt::format("more than {} control points; split the edge", kMostCurvePoints);
  if (n.knots.size() != n.points_m.size() + n.degree + 1) {
    return fmt::format("{} control points of degree {} need {} knots; here are {}", n.points_m.size(), n.degree,
                       n.points_m.size() + n.degree + 1, n.knots.size());
  }
  if (!std::ranges::is_sorted(n.knots)) return "the knots do not ascend; put them in order";
  if (!(n.knots[n.degree] < n.knots[n.points_m.size()])) return "all knots are equal; they run from 0 to 1";
  for (const double weight : n.weights) {
    if (!(weight > 0.0)) return fmt::format("weight {} is not positive; correct it, or leave it out for 1", weight);
  }
  return "";
}

std::string fault_of_ends(const Vec2& begin_m, const Vec2& end_m, const Vec2& from_m, const Vec2& to_m,
                          std::string_view point) {
  // The check of the layout names a point that lies on no map.
  constexpr double kBeyondAnyMap_m = 1e8;
  if (!(std::max(from_m.cwiseAbs().maxCoeff(), to_m.cwiseAbs().maxCoeff()) < kBeyondAnyMap_m)) return "";
  const double before_m = (begin_m - from_m).norm(), behind_m = (end_m - to_m).norm();
  if (before_m <= kFarBeside_m && behind_m <= kFarBeside_m) return "";
  const bool begins = before_m > behind_m;
  const Vec2 &at_m = begins ? begin_m : end_m, &there_m = begins ? from_m : to_m;
  return fmt::format(
      "the curve {} at ({:g}, {:g}) m, {:.3f} m beside its {} at ({:g}, {:g}) m, and no AGV can drive from one to the "
      "other; give the curve in the coordinates of the {}s, or correct the {}",
      begins ? "begins" : "ends", at_m.x(), at_m.y(), std::max(before_m, behind_m), point, there_m.x(), there_m.y(),
      point, point);
}

CubicPieces cubic_pieces(const Nurbs& n, const NearCurve& near) {
  if (n.degree == 1) {
    auto way = round_corners(n.points_m);
    return {n.points_m.front(), n.points_m.back(), std::move(way.control_points_m), way.off_m};
  }
  CubicPieces pieces{n.points_m.front(), n.points_m.back(), {}, 0.0};
  if (n.degree <= 3 && in_bezier_form(n) && equal_weights(n)) {
    const auto cubic = n.degree == 2 ? raised_from_quadratic(n.points_m) : n.points_m;
    pieces.control_points_m.assign(cubic.begin() + 1, cubic.end() - 1);
    return pieces;
  }
  const auto cubics = pieces_along(n, near);
  pieces.off_m = near.m;
  if (cubics.empty()) return pieces;
  pieces.begin_m = cubics.front().begin_m;
  pieces.end_m = cubics.back().end_m;
  for (std::size_t i = 0; i < cubics.size(); ++i) {
    if (i > 0) pieces.control_points_m.push_back(cubics[i].begin_m);
    pieces.control_points_m.push_back(cubics[i].first_m);
    pieces.control_points_m.push_back(cubics[i].second_m);
  }
  return pieces;
}

}  // namespace fleetproof
