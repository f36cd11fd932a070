#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "tests/oracle/point.hpp"

namespace fleetproof::oracle {

// A cubic Bezier curve by arc length: a table of Simpson's rule, then Newton's method. Right to 1e-12 m for the curves
// of this folder, which never stand still.
class BezierTrack {
 public:
  explicit BezierTrack(const std::array<Point, 4>& control_points) : p_(control_points), reached_(kCells + 1) {
    double last_bend = bend_at(0.0);
    for (std::size_t i = 0; i < kCells; ++i) {
      const double from = place(i), to = place(i + 1), bend = bend_at(to), way = simpson(from, to);
      reached_[i + 1] = reached_[i] + way;
      sharpest_ = std::max({sharpest_, std::abs(bend), std::abs(last_bend)});
      steepest_ = std::max(steepest_, std::abs(bend - last_bend) / way);
      last_bend = bend;
    }
  }

  const std::array<Point, 4>& control_points() const { return p_; }
  double length() const { return reached_.back(); }
  // The largest curvature, and its largest change by arc length: samples, and a tenth more.
  double sharpest() const { return 1.1 * sharpest_; }
  double steepest() const { return 1.1 * steepest_; }

  Point at(double t) const {
    const double u = 1.0 - t;
    return u * u * u * p_[0] + 3.0 * u * u * t * p_[1] + 3.0 * u * t * t * p_[2] + t * t * t * p_[3];
  }
  Point tangent(double t) const {
    const double u = 1.0 - t;
    return 3.0 * u * u * (p_[1] - p_[0]) + 6.0 * u * t * (p_[2] - p_[1]) + 3.0 * t * t * (p_[3] - p_[2]);
  }
  double bend_at(double t) const {
    const Point v = tangent(t),
                a = 6.0 * (1.0 - t) * (p_[2] - 2.0 * p_[1] + p_[0]) + 6.0 * t * (p_[3] - 2.0 * p_[2] + p_[1]);
    return cross(v, a) / std::pow(oracle::length(v), 3);
  }
  // The parameter at an arc length.
  double parameter(double way) const {
    if (way <= 0.0) return 0.0;
    if (way >= length()) return 1.0;
    const auto above = std::upper_bound(reached_.begin(), reached_.end(), way);
    const auto cell = static_cast<std::size_t>(above - reached_.begin()) - 1;
    const double from = place(cell), left = way - reached_[cell];
    double t = from + left / oracle::length(tangent(from));
    for (int i = 0; i < 3; ++i) t += (left - simpson(from, t)) / oracle::length(tangent(t));
    return t;
  }

 private:
  static constexpr std::size_t kCells = 2'000;
  static double place(std::size_t cell) { return static_cast<double>(cell) / kCells; }
  double simpson(double from, double to) const {
    return (to - from) / 6.0 *
           (oracle::length(tangent(from)) + 4.0 * oracle::length(tangent(0.5 * (from + to))) +
            oracle::length(tangent(to)));
  }

  std::array<Point, 4> p_;
  std::vector<double> reached_;
  double sharpest_ = 0.0, steepest_ = 0.0;
};

}  // namespace fleetproof::oracle
