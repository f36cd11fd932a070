#include "generators/formats/rounded_way.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/tolerances.hpp"

namespace fleetproof {
namespace {

constexpr double kTurnsRound = 0.02;  // 1 + the cosine of 168 degrees

std::vector<Vec2> without_doubles(const std::vector<Vec2>& points_m) {
  std::vector<Vec2> kept;
  for (const Vec2& point_m : points_m) {
    if (kept.empty() || (point_m - kept.back()).norm() > kNurbsPoint_m) kept.push_back(point_m);
  }
  return kept;
}

// Whether all points lie on the line between the outermost ones, in this order.
bool is_straight(const std::vector<Vec2>& p) {
  const Vec2 way = p.back() - p.front();
  const double length_m = way.norm();
  if (length_m < kNurbsPoint_m) return false;
  double reached_m = 0.0;
  for (const Vec2& point_m : p) {
    const Vec2 to_m = point_m - p.front();
    const double along_m = to_m.dot(way) / length_m;
    if (!(std::abs(cross(to_m, way)) <= kNurbsPoint_m * length_m) || along_m < reached_m - kNurbsPoint_m) return false;
    reached_m = along_m;
  }
  return true;
}

// Where cubic pieces begin and end, and their control points.
class Pieces {
 public:
  explicit Pieces(const Vec2& begin_m) : points_m_{begin_m} {}

  void go_straight(const Vec2& to_m) {
    const Vec2 from_m = points_m_.back();
    if ((to_m - from_m).norm() > kNurbsPoint_m) go(from_m + (to_m - from_m) / 3.0, to_m - (to_m - from_m) / 3.0, to_m);
  }
  void go(const Vec2& first_m, const Vec2& second_m, const Vec2& to_m) {
    points_m_.insert(points_m_.end(), {first_m, second_m, to_m});
  }
  std::vector<Vec2> control_points_m() const { return {points_m_.begin() + 1, points_m_.end() - 1}; }

 private:
  std::vector<Vec2> points_m_;
};

// The arc has the radius `cut_m` / tan(angle / 2), and the handles of the usual cubic for it: 4/3 tan(angle / 4) radii.
double go_round(const Vec2& corner_m, const Vec2& in, const Vec2& out, double cut_m, Pieces& pieces) {
  const double tangent_of_half = std::abs(cross(in, out)) / (1.0 + in.dot(out));
  const double handle_m = 4.0 / 3.0 * cut_m / (1.0 + std::sqrt(1.0 + tangent_of_half * tangent_of_half));
  const Vec2 begin_m = corner_m - in * cut_m, end_m = corner_m + out * cut_m;
  const Vec2 first_m = begin_m + in * handle_m, second_m = end_m - out * handle_m;
  pieces.go_straight(begin_m);
  pieces.go(first_m, second_m, end_m);
  return ((begin_m + 3.0 * (first_m + second_m) + end_m) / 8.0 - corner_m).norm();
}

}  // namespace

RoundedWay round_corners(const std::vector<Vec2>& points_m) {
  const auto p = without_doubles(points_m);
  if (p.size() < 3 || is_straight(p)) return {};
  Pieces pieces(p.front());
  double off_m = 0.0;
  for (std::size_t i = 1; i + 1 < p.size(); ++i) {
    const Vec2 leg_in_m = p[i] - p[i - 1], leg_out_m = p[i + 1] - p[i];
    const Vec2 in = leg_in_m.normalized(), out = leg_out_m.normalized();
    const double shorter_m = std::min(leg_in_m.norm(), leg_out_m.norm());
    if (1.0 + in.dot(out) < kTurnsRound) {
      pieces.go_straight(p[i]);
    } else {
      off_m = std::max(off_m, go_round(p[i], in, out, std::min(kCornerRounding_m, shorter_m / 2.0), pieces));
    }
  }
  pieces.go_straight(p.back());
  return {pieces.control_points_m(), off_m};
}

}  // namespace fleetproof
