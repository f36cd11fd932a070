// The points at which two bodies are nearest, which may be points that both share, and how fast they are there.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

#include "core/base/tolerances.hpp"
#include "core/geometry/rectangle.hpp"
#include "core/motion/piece.hpp"

namespace fleetproof::shared_points {

// A point of each of two bodies, both on the floor.
struct PointPair {
  Vec2 on_first, on_second;

  double gap_m() const { return (on_second - on_first).norm(); }
};

using Corners = std::array<Vec2, 4>;

// In this order: front left, rear left, rear right, front right. A side begins at the corner with its number: left,
// rear, right, front.
inline Corners corners(const OrientedRectangle& body) {
  const Vec2 along = body.half_length_m * body.heading, aside = body.half_width_m * left_of(body.heading);
  return {body.centre_m + along + aside, body.centre_m - along + aside, body.centre_m - along - aside,
          body.centre_m + along - aside};
}

inline Vec2 nearest_point_of(const OrientedRectangle& body, const Vec2& point_m) {
  const Vec2 offset = point_m - body.centre_m;
  const double along = std::clamp(offset.dot(body.heading), -body.half_length_m, body.half_length_m);
  const double aside = std::clamp(cross(body.heading, offset), -body.half_width_m, body.half_width_m);
  return body.centre_m + along * body.heading + aside * left_of(body.heading);
}

// A bound on a speed is worked out in another way than the speed. The difference by rounding is far below this.
inline constexpr double kRounding_mps = 1e-9;

// What a view leaves out is farther away than this, which is far beyond its rounding.
inline constexpr double kClearlyAway_m = 1e-6;

// A rectangle as seen from the frame of another one. It selects what is then worked out exactly.
class View {
 public:
  View(const OrientedRectangle& from, const OrientedRectangle& other)
      : half_length_m_(from.half_length_m + kClearlyAway_m), half_width_m_(from.half_width_m + kClearlyAway_m) {
    const double cosine = from.heading.dot(other.heading), sine = cross(from.heading, other.heading);
    const Vec2 offset = other.centre_m - from.centre_m;
    heading_ = {cosine, sine};
    x_ = offset.dot(from.heading);
    y_ = cross(from.heading, offset);
    length_x_ = other.half_length_m * cosine;
    length_y_ = other.half_length_m * sine;
    width_x_ = -other.half_width_m * sine;
    width_y_ = other.half_width_m * cosine;
  }

  // Which corners of the other rectangle may lie in this one: a bit each.
  // `near_m`: or this near to it.
  unsigned corners_inside(double near_m = 0.0) const {
    return inside(1.0, 1.0, near_m) | inside(-1.0, 1.0, near_m) << 1U | inside(-1.0, -1.0, near_m) << 2U |
           inside(1.0, -1.0, near_m) << 3U;
  }
  // For each side of the other rectangle: which sides of this one lie on lines that it may cross, a bit each.
  std::array<unsigned, 4> lines_crossed() const {
    const double long_x = std::abs(length_x_) + 2.0 * kClearlyAway_m,
                 long_y = std::abs(length_y_) + 2.0 * kClearlyAway_m,
                 short_x = std::abs(width_x_) + 2.0 * kClearlyAway_m,
                 short_y = std::abs(width_y_) + 2.0 * kClearlyAway_m;
    return {lines_crossed(x_ + width_x_, y_ + width_y_, long_x, long_y),
            lines_crossed(x_ - length_x_, y_ - length_y_, short_x, short_y),
            lines_crossed(x_ - width_x_, y_ - width_y_, long_x, long_y),
            lines_crossed(x_ + length_x_, y_ + length_y_, short_x, short_y)};
  }
  // Of the other rectangle.
  Corners corners() const {
    return {Vec2(x_ + length_x_ + width_x_, y_ + length_y_ + width_y_),
            Vec2(x_ - length_x_ + width_x_, y_ - length_y_ + width_y_),
            Vec2(x_ - length_x_ - width_x_, y_ - length_y_ - width_y_),
            Vec2(x_ + length_x_ - width_x_, y_ + length_y_ - width_y_)};
  }
  // A vector of this frame, in the frame of the other rectangle.
  Vec2 in_other(const Vec2& vector) const { return {vector.dot(heading_), cross(heading_, vector)}; }
  // Around the other rectangle.
  Box box() const {
    const Vec2 centre(x_, y_), reach(std::abs(length_x_) + std::abs(width_x_) + kClearlyAway_m,
                                     std::abs(length_y_) + std::abs(width_y_) + kClearlyAway_m);
    return {centre - reach, centre + reach};
  }

 private:
  static unsigned bit(bool is) { return is ? 1U : 0U; }
  // By a side with this middle, which reaches so far from there.
  unsigned lines_crossed(double x, double y, double reach_x, double reach_y) const {
    return bit(std::abs(y - half_width_m_) <= reach_y) | bit(std::abs(x + half_length_m_) <= reach_x) << 1U |
           bit(std::abs(y + half_width_m_) <= reach_y) << 2U | bit(std::abs(x - half_length_m_) <= reach_x) << 3U;
  }
  unsigned inside(double ahead, double left, double near_m) const {
    return bit(std::abs(x_ + ahead * length_x_ + left * width_x_) <= half_length_m_ + near_m &&
               std::abs(y_ + ahead * length_y_ + left * width_y_) <= half_width_m_ + near_m);
  }

  double half_length_m_, half_width_m_;             // of this rectangle, a little grown
  Vec2 heading_;                                    // of the other one
  double x_, y_;                                    // its centre
  double length_x_, length_y_, width_x_, width_y_;  // its half length and half width
};

// Points of two rectangles that may be corners of what they share: corners of each, a bit each; and for each side of
// the first one, the sides of the second one that may cross it, a bit each.
struct SharedCandidates {
  unsigned of_first = 0, of_second = 0;
  std::array<unsigned, 4> crossings{};
};

// The two rectangles of a pair, each as seen from the other one.
struct Views {
  View from_first, from_second;

  SharedCandidates candidates() const {
    SharedCandidates found{from_second.corners_inside(), from_first.corners_inside(), from_second.lines_crossed()};
    const auto by_second = from_first.lines_crossed();
    for (std::size_t i = 0; i < 4; ++i) {
      for (unsigned j = 0; j < 4; ++j) {
        if ((by_second[j] >> i & 1U) == 0) found.crossings[i] &= ~(1U << j);
      }
    }
    return found;
  }

  Views(const OrientedRectangle& first, const OrientedRectangle& second)
      : from_first(first, second), from_second(second, first) {}
};

// Where two sides cross. Parallel sides share corners, or nothing.
inline std::optional<Vec2> crossing(const Corners& first, std::size_t i, const Corners& second, std::size_t j) {
  const Vec2 side = first[(i + 1) % 4] - first[i], other = second[(j + 1) % 4] - second[j],
             between = second[j] - first[i];
  const double sine = cross(side, other);
  if (std::abs(sine) <= kAlongSide * side.norm() * other.norm()) return std::nullopt;
  const double here = cross(between, other) / sine, there = cross(between, side) / sine;
  if (here < 0.0 || here > 1.0 || there < 0.0 || there > 1.0) return std::nullopt;
  return Vec2(first[i] + here * side);
}

// The corners of what two rectangles share that overlap; both points of a pair are the same.
template <class Visit>
void for_shared(const OrientedRectangle& first, const OrientedRectangle& second, const SharedCandidates& candidates,
                const Visit& visit) {
  const Corners of_first = corners(first), of_second = corners(second);
  const auto visit_shared = [&](const PointPair& pair) {
    if (pair.gap_m() <= kEquallyNear_m) visit(pair);
  };
  for (unsigned left = candidates.of_first; left != 0; left &= left - 1) {
    const Vec2& corner = of_first[static_cast<std::size_t>(std::countr_zero(left))];
    visit_shared({corner, nearest_point_of(second, corner)});
  }
  for (unsigned left = candidates.of_second; left != 0; left &= left - 1) {
    const Vec2& corner = of_second[static_cast<std::size_t>(std::countr_zero(left))];
    visit_shared({nearest_point_of(first, corner), corner});
  }
  for (std::size_t i = 0; i < 4; ++i) {
    for (unsigned left = candidates.crossings[i]; left != 0; left &= left - 1) {
      const auto at = crossing(of_first, i, of_second, static_cast<std::size_t>(std::countr_zero(left)));
      if (at) visit({*at, *at});
    }
  }
}

// The points at which two rectangles are nearest. If a whole edge is nearest, both of its ends. If the rectangles
// overlap, the corners of what they share; both points of such a pair are the same. Never empty.
class NearestPoints {
 public:
  // Of two that are apart.
  NearestPoints(const OrientedRectangle& first, const OrientedRectangle& second) {
    for (const Vec2& corner : corners(first)) add({corner, nearest_point_of(second, corner)});
    for (const Vec2& corner : corners(second)) add({nearest_point_of(first, corner), corner});
    double least_m = std::numeric_limits<double>::infinity();
    for (const PointPair& pair : *this) least_m = std::min(least_m, pair.gap_m());
    const auto farther = [&](const PointPair& pair) { return pair.gap_m() > least_m + kEquallyNear_m; };
    count_ = static_cast<std::size_t>(std::remove_if(pairs_.data(), pairs_.data() + count_, farther) - pairs_.data());
  }
  // Of two that overlap.
  NearestPoints(const OrientedRectangle& first, const OrientedRectangle& second, const SharedCandidates& candidates) {
    for_shared(first, second, candidates, [&](const PointPair& pair) { add(pair); });
  }

  const PointPair* begin() const { return pairs_.data(); }
  const PointPair* end() const { return pairs_.data() + count_; }

 private:
  void add(const PointPair& pair) { pairs_[count_++] = pair; }

  std::array<PointPair, 4 + 4 + 16> pairs_;
  std::size_t count_ = 0;
};

// How a body moves at an instant.
struct Twist {
  Vec2 reference_m, velocity_mps;
  double turning_rad_s = 0.0;

  Vec2 velocity_of(const Vec2& point_m) const {
    return velocity_mps + turning_rad_s * left_of(Vec2(point_m - reference_m));
  }
};

// A body at an instant.
struct Moment {
  OrientedRectangle body;
  Twist twist;
};

inline Moment moment_of(const Piece& piece, SimTime t) {
  Moment moment;
  Twist& twist = moment.twist;
  const auto stands = [&](const Pose& pose) {
    moment.body = placed(piece.footprint, pose);
    twist = {moment.body.centre_m - piece.footprint.centre_ahead_m * moment.body.heading, Vec2::Zero()};
  };
  if (piece.manner == Manner::Rest) {
    stands(piece.start);
    return moment;
  }
  const double sign = piece.moves_against_heading() ? -1.0 : 1.0;
  const double speed = piece.profile.speed(to_seconds(std::clamp(t, piece.begin, piece.end) - piece.begin));
  if (piece.manner == Manner::Turn) {
    stands(piece.pose_at(t));
    twist.turning_rad_s = sign * speed;
  } else {
    const double way_m = piece.way_at(t);
    stands(piece.curve->pose_at(way_m));
    twist.velocity_mps = sign * speed * moment.body.heading;
    if (!piece.curve->is_straight()) twist.turning_rad_s = speed * piece.curve->bending_at(way_m).per_m;
  }
  return moment;
}

// Two bodies at an instant.
struct Meeting {
  Moment a, b;

  Meeting(const Piece& one, const Piece& other, SimTime t) : a(moment_of(one, t)), b(moment_of(other, t)) {}

  // How the first moves at a point, against the second at another one.
  Vec2 closing_mps(const PointPair& at) const {
    return a.twist.velocity_of(at.on_first) - b.twist.velocity_of(at.on_second);
  }
  NearestPoints nearest(bool overlap) const {
    return overlap ? NearestPoints(a.body, b.body, Views(a.body, b.body).candidates()) : NearestPoints(a.body, b.body);
  }
  // Of two bodies that are apart, and of two that overlap, at these points.
  double highest_apart_mps() const {
    double square = 0.0;
    for (const PointPair& pair : NearestPoints(a.body, b.body))
      square = std::max(square, closing_mps(pair).squaredNorm());
    return std::sqrt(square);
  }
  double highest_shared_mps(const SharedCandidates& candidates) const {
    double square = 0.0;
    for_shared(a.body, b.body, candidates,
               [&](const PointPair& pair) { square = std::max(square, closing_mps(pair).squaredNorm()); });
    return std::sqrt(square);
  }
};

}  // namespace fleetproof::shared_points
