#include "generators/formats/rounded_way.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/tolerances.hpp"

namespace fleetproof {
namespace {

constexpr double kTurnsRound = 0.02;           // 1 + the cosine of 168 degrees
constexpr double kHalfOfRightAngle = 0.70710;  // a little less than the cosine of 45 degrees

std::vector<Vec2> without_doubles(const std::vector<Vec2>& points_m) {
  std::vector<Vec2> kept;
  for (const Vec2& point_m : points_m) {
    if (kept.empty() || (point_m - kept.back()).norm() > kNurbsPoint_m) kept.push_back(point_m);
  }
  return kept;
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

struct Circle {
  Vec2 centre_m;
  double side;  // 1: driven to the left, -1: to the right
};

// From one place to another, both as seen from the centre. An arc that turns by more than 45 degrees is halved.
void go_along(const Circle& circle, const Vec2& from_m, const Vec2& to_m, int halves_left, Pieces& pieces) {
  const double turned = circle.side * cross(from_m, to_m), r2 = from_m.squaredNorm();
  if (halves_left > 0 && !(turned > 0.0 && from_m.dot(to_m) > kHalfOfRightAngle * r2)) {
    const Vec2 outward = -circle.side * left_of(to_m - from_m);
    const Vec2 middle_m = outward.stableNormalized() * std::sqrt(r2);
    go_along(circle, from_m, middle_m, halves_left - 1, pieces);
    return go_along(circle, middle_m, to_m, halves_left - 1, pieces);
  }
  const double tangent_of_half = turned / (r2 + from_m.dot(to_m));
  const double handle =
      circle.side * 4.0 / 3.0 * tangent_of_half / (1.0 + std::sqrt(1.0 + tangent_of_half * tangent_of_half));
  pieces.go(circle.centre_m + from_m + handle * left_of(from_m), circle.centre_m + to_m - handle * left_of(to_m),
            circle.centre_m + to_m);
}

}  // namespace

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

std::vector<Vec2> arc_through(const Vec2& from_m, const Vec2& via_m, const Vec2& to_m) {
  constexpr int kMostHalves = 4;
  const Vec2 a = via_m - from_m, b = to_m - from_m;
  const double twice_area_m2 = cross(a, b);
  if (!(std::abs(twice_area_m2) > kNurbsPoint_m * b.norm())) return {};
  const Vec2 to_centre_m = (left_of(b) * a.squaredNorm() - left_of(a) * b.squaredNorm()) / (-2.0 * twice_area_m2);
  const Circle circle{from_m + to_centre_m, cross(a, to_m - via_m) > 0.0 ? 1.0 : -1.0};
  Pieces pieces(from_m);
  go_along(circle, -to_centre_m, to_m - circle.centre_m, kMostHalves, pieces);
  return pieces.control_points_m();
}

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
