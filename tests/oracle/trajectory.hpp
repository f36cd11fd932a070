#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "tests/oracle/bezier_track.hpp"

// Trajectories as the paper defines them, evaluated by formulas of this folder's own: libm's sine and cosine, no code
// of the program under test. Metres, seconds, radians; instants are whole nanoseconds.
namespace fleetproof::oracle {

using Nanoseconds = std::int64_t;

struct Limits {
  double speed = 2.0, acceleration = 0.5, deceleration = 1.0;
};

// From rest to rest (Sect. 3.3): up at `acceleration`, level at `speed` if it is reached, down at `deceleration`.
class Trapezoid {
 public:
  Trapezoid() = default;
  Trapezoid(double distance, const Limits& limits) : distance_(distance), limits_(limits) {
    const double a = limits.acceleration, d = limits.deceleration, v = limits.speed,
                 ramps = v * v / (2.0 * a) + v * v / (2.0 * d);
    top_ = ramps < distance ? v : std::sqrt(2.0 * distance / (1.0 / a + 1.0 / d));
    up_s_ = top_ / a;
    level_s_ = ramps < distance ? (distance - ramps) / v : 0.0;
    down_s_ = top_ / d;
  }
  double duration_s() const { return up_s_ + level_s_ + down_s_; }
  double top() const { return top_; }
  double strongest() const { return std::max(limits_.acceleration, limits_.deceleration); }
  double way(double t_s) const {
    if (t_s <= 0.0) return 0.0;
    if (t_s >= duration_s()) return distance_;
    if (t_s <= up_s_) return limits_.acceleration * t_s * t_s / 2.0;
    const double risen = top_ * top_ / (2.0 * limits_.acceleration);
    if (t_s <= up_s_ + level_s_) return risen + top_ * (t_s - up_s_);
    const double braking_s = t_s - up_s_ - level_s_;
    return risen + top_ * level_s_ + top_ * braking_s - limits_.deceleration * braking_s * braking_s / 2.0;
  }

 private:
  double distance_ = 0.0, top_ = 0.0, up_s_ = 0.0, level_s_ = 0.0, down_s_ = 0.0;
  Limits limits_;
};

// A line (curvature 0), an arc (positive curvature bends left), or a Bezier curve whose first point is `from`.
struct Stroke {
  Point from, heading;
  double length = 0.0, curvature = 0.0;
  std::shared_ptr<const BezierTrack> bezier = nullptr;  // its first control point is (0, 0)

  double sharpest() const { return bezier ? bezier->sharpest() : std::abs(curvature); }
  double steepest() const { return bezier ? bezier->steepest() : 0.0; }
};
inline Stroke bezier_stroke(const std::array<Point, 4>& p) {
  const auto track =
      std::make_shared<const BezierTrack>(std::array<Point, 4>{Point{}, p[1] - p[0], p[2] - p[0], p[3] - p[0]});
  const Point way = track->tangent(0.0);
  return {p[0], (1.0 / length(way)) * way, track->length(), 0.0, track};
}

using Corners = std::array<Point, 4>;  // counter-clockwise

enum class Manner { Rest, Drive, Turn };

// What one body does from `begin` to `end`, and where that puts its corners.
struct Trajectory {
  Manner manner = Manner::Rest;
  Nanoseconds begin = 0, end = 0;
  double body_length = 1.8, body_width = 1.2;
  double ahead = 0.0;       // of the point that follows the strokes, and about which the body turns: the body's centre
  bool tail_first = false;  // Drive
  Point at, heading{1.0, 0.0};  // Rest and Turn
  std::vector<Stroke> strokes;  // Drive
  double turn_rad = 0.0;        // Turn, left positive
  Limits limits;
  Trapezoid profile;

  // No corner is farther from the point that follows the strokes.
  double reach() const { return std::abs(ahead) + 0.5 * std::hypot(body_length, body_width); }
  double elapsed_s(Nanoseconds t) const { return static_cast<double>(t - begin) * 1e-9; }

  void place(Nanoseconds t, Point& centre, Point& nose) const {
    follow(t, centre, nose);
    if (manner == Manner::Drive && tail_first) nose = -1.0 * nose;
    centre = centre + ahead * nose;
  }

  // Of the point that follows the strokes, with the way it goes.
  void follow(Nanoseconds t, Point& centre, Point& nose) const {
    centre = at, nose = heading;
    if (manner == Manner::Rest) return;
    double way = profile.way(elapsed_s(t));
    if (manner == Manner::Turn) {
      const Point turned = direction(turn_rad < 0.0 ? -way : way);
      nose = {heading.x * turned.x - heading.y * turned.y, heading.x * turned.y + heading.y * turned.x};
      return;
    }
    std::size_t i = 0;
    for (; i + 1 < strokes.size() && way > strokes[i].length; ++i) way -= strokes[i].length;
    const Stroke& s = strokes[i];
    if (s.bezier) {
      const double u = s.bezier->parameter(way);
      const Point along = s.bezier->tangent(u);
      centre = s.from + s.bezier->at(u), nose = (1.0 / length(along)) * along;
      return;
    }
    if (s.curvature == 0.0) {
      centre = s.from + way * s.heading, nose = s.heading;
      return;
    }
    const double angle = s.curvature * way, half = std::sin(angle / 2.0);
    const double sine = std::sin(angle), versine = 2.0 * half * half;
    centre = s.from + (sine / s.curvature) * s.heading + (versine / s.curvature) * left_of(s.heading);
    nose = (1.0 - versine) * s.heading + sine * left_of(s.heading);
  }

  Corners corners(Nanoseconds t) const {
    Point centre, nose;
    place(t, centre, nose);
    const Point l = 0.5 * body_length * nose, w = 0.5 * body_width * left_of(nose);
    return {centre + l + w, centre - l + w, centre - l - w, centre + l - w};
  }

  double sharpest_bend() const {
    double most = 0.0;
    for (const Stroke& s : strokes) most = std::max(most, s.sharpest());
    return most;
  }
  double steepest_bend() const {
    double most = 0.0;
    for (const Stroke& s : strokes) most = std::max(most, s.steepest());
    return most;
  }
  bool on_bezier() const {
    return std::any_of(strokes.begin(), strokes.end(), [](const Stroke& s) { return s.bezier != nullptr; });
  }
  // No point of the body is ever faster.
  double fastest_mps() const {
    if (manner == Manner::Rest) return 0.0;
    return manner == Manner::Turn ? profile.top() * reach() : profile.top() * (1.0 + sharpest_bend() * reach());
  }
  // No point of the body is ever accelerated more, but where two strokes meet.
  double strongest_mps2() const {
    if (manner == Manner::Rest) return 0.0;
    const double v = profile.top(), a = profile.strongest(), bend = sharpest_bend();
    return manner == Manner::Turn ? (a + v * v) * reach()
                                  : (a + bend * v * v) * (1.0 + bend * reach()) + steepest_bend() * v * v * reach();
  }
  // Whether a joint of two strokes is passed strictly within: there, corners change their velocity at once.
  bool joint_between(Nanoseconds from, Nanoseconds to) const {
    double sum = 0.0;
    const double first = profile.way(elapsed_s(from)), last = profile.way(elapsed_s(to));
    for (std::size_t i = 0; i + 1 < strokes.size(); ++i) {
      sum += strokes[i].length;
      if (sum >= first - 1e-9 && sum <= last + 1e-9) return true;
    }
    return false;
  }
};

}  // namespace fleetproof::oracle
