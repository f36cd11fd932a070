#include "core/clearance/relative_speed.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/tolerances.hpp"
#include "core/geometry/rectangle.hpp"

namespace fleetproof {
namespace {

// A point of each of two bodies, both on the floor.
struct PointPair {
  Vec2 on_first, on_second;
};

std::array<Vec2, 4> corners(const OrientedRectangle& body) {
  const Vec2 along = body.half_length_m * body.heading, aside = body.half_width_m * left_of(body.heading);
  return {body.centre_m + along + aside, body.centre_m - along + aside, body.centre_m - along - aside,
          body.centre_m + along - aside};
}

Vec2 nearest_point_of(const OrientedRectangle& body, const Vec2& point_m) {
  const Vec2 offset = point_m - body.centre_m;
  const double along = std::clamp(offset.dot(body.heading), -body.half_length_m, body.half_length_m);
  const double aside = std::clamp(cross(body.heading, offset), -body.half_width_m, body.half_width_m);
  return body.centre_m + along * body.heading + aside * left_of(body.heading);
}

// Where the sides of the two rectangles cross. Parallel sides share corners, or nothing.
void add_crossings(const std::array<Vec2, 4>& first, const std::array<Vec2, 4>& second, std::vector<PointPair>& pairs) {
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec2 side = first[(i + 1) % 4] - first[i];
    for (std::size_t j = 0; j < 4; ++j) {
      const Vec2 other = second[(j + 1) % 4] - second[j], between = second[j] - first[i];
      const double sine = cross(side, other);
      if (std::abs(sine) <= kAlongSide * side.norm() * other.norm()) continue;
      const double here = cross(between, other) / sine, there = cross(between, side) / sine;
      if (here < 0.0 || here > 1.0 || there < 0.0 || there > 1.0) continue;
      const Vec2 at = first[i] + here * side;
      pairs.push_back({at, at});
    }
  }
}

// The points at which two rectangles are nearest. If a whole edge is nearest, both of its ends. If the rectangles
// overlap, the corners of what they share; both points of such a pair are the same. Never empty.
std::vector<PointPair> nearest_points(const OrientedRectangle& first, const OrientedRectangle& second) {
  const auto of_first = corners(first), of_second = corners(second);
  std::vector<PointPair> pairs;
  pairs.reserve(of_first.size() + of_second.size() + of_first.size() * of_second.size());
  double least_m = std::numeric_limits<double>::infinity();
  const auto offer = [&](const PointPair& pair) {
    pairs.push_back(pair);
    least_m = std::min(least_m, (pair.on_second - pair.on_first).norm());
  };
  for (const Vec2& corner : of_first) offer({corner, nearest_point_of(second, corner)});
  for (const Vec2& corner : of_second) offer({nearest_point_of(first, corner), corner});
  const bool overlap = clearance_m(first, second) <= 0.0;
  if (overlap) {
    add_crossings(of_first, of_second, pairs);
    least_m = 0.0;
  }
  std::vector<PointPair> nearest;
  std::ranges::copy_if(pairs, std::back_inserter(nearest), [&](const PointPair& pair) {
    return (pair.on_second - pair.on_first).norm() <= least_m + kEquallyNear_m;
  });
  return nearest;
}

// How a body moves at an instant.
struct Twist {
  Vec2 reference_m, velocity_mps;
  double turning_rad_s = 0.0;

  Vec2 velocity_of(const Vec2& point_m) const {
    return velocity_mps + turning_rad_s * left_of(Vec2(point_m - reference_m));
  }
};

Twist twist_of(const Piece& piece, const OrientedRectangle& body, SimTime t) {
  Twist twist{body.centre_m - piece.footprint.centre_ahead_m * body.heading, Vec2::Zero()};
  if (piece.manner == Manner::Rest) return twist;
  const double speed = piece.profile.speed(to_seconds(std::clamp(t, piece.begin, piece.end) - piece.begin));
  if (piece.manner == Manner::Turn) {
    twist.turning_rad_s = piece.moves_against_heading() ? -speed : speed;
  } else {
    twist.velocity_mps = (piece.moves_against_heading() ? -speed : speed) * body.heading;
    twist.turning_rad_s = speed * piece.curve->bending_at(piece.way_at(t)).per_m;
  }
  return twist;
}

// The relative speed of every pair of nearest points.
template <class Visit>
void for_nearest(const Piece& a, const Piece& b, SimTime t, const Visit& visit) {
  const OrientedRectangle body_a = a.body_at(t), body_b = b.body_at(t);
  const Twist one = twist_of(a, body_a, t), other = twist_of(b, body_b, t);
  const Vec2 normal = separation(body_a, body_b).direction;
  for (const auto& [on_a, on_b] : nearest_points(body_a, body_b)) {
    const Vec2 closing_mps = one.velocity_of(on_a) - other.velocity_of(on_b);
    visit(RelativeSpeed{closing_mps.norm(), closing_mps.dot(normal)});
  }
}

class FastestInstant {
 public:
  FastestInstant(const Piece& a, const Piece& b, double below_m, EvaluationCount& count)
      : a_(a), b_(b), below_m_(below_m), count_(count) {}

  RelativeSpeed within(Interval all) {
    offer(all.begin, all);
    for (SimTime t = all.begin; t < all.end;) {
      const SimTime next = change_after(t, all.end);
      sample({t, next});
      t = next;
    }
    narrow();
    return fastest_;
  }

 private:
  SimTime change_after(SimTime t, SimTime end) const {
    const SimTime of_a = motion_from(a_, a_.body_at(t), t, end, TimeSense::Forward).change,
                  of_b = motion_from(b_, b_.body_at(t), t, end, TimeSense::Forward).change;
    return std::max(t + Duration{1}, std::min({of_a, of_b, end}));
  }

  // Without rotation, the relative speed between two changes is largest at one of them. An arc ends in a step of the
  // turning rate: both sides of a change count.
  void sample(Interval phase) {
    constexpr int kSamples = 64;
    const bool steady = a_.keeps_heading() && b_.keeps_heading();
    const Duration step = std::max((phase.end - phase.begin) / (steady ? 1 : kSamples), Duration{1});
    const auto offer_near = [&](SimTime t) {
      offer(t, {std::max(phase.begin, t - step), std::min(phase.end, t + step)});
    };
    for (SimTime t = phase.begin + Duration{1}; t < phase.end; t += step) offer_near(t);
    offer_near(phase.end - Duration{1});
    offer_near(phase.end);
  }

  double offer(SimTime t, Interval around) {
    ++count_.distance;
    if (clearance_m(a_.body_at(t), b_.body_at(t)) >= below_m_) return 0.0;
    const RelativeSpeed here = relative_speed(a_, b_, t);
    if (here.speed_mps > fastest_.speed_mps) {
      fastest_ = here;
      around_ = around;
    }
    return here.speed_mps;
  }

  // To the nanosecond, between the neighbours of the fastest sample.
  void narrow() {
    if (a_.keeps_heading() && b_.keeps_heading()) return;
    Interval left = around_;
    while (left.end - left.begin > Duration{2}) {
      const Duration third = (left.end - left.begin) / 3;
      const SimTime low = left.begin + third, high = left.end - third;
      if (offer(low, around_) < offer(high, around_)) {
        left.begin = low;
      } else {
        left.end = high;
      }
    }
  }

  const Piece& a_;
  const Piece& b_;
  double below_m_;
  EvaluationCount& count_;
  RelativeSpeed fastest_;
  Interval around_;  // the neighbours of the fastest sample
};

}  // namespace

RelativeSpeed relative_speed(const Piece& a, const Piece& b, SimTime t) {
  RelativeSpeed fastest;
  if (a.manner == Manner::Rest && b.manner == Manner::Rest) return fastest;
  for_nearest(a, b, t, [&](const RelativeSpeed& one) {
    if (one.speed_mps > fastest.speed_mps) fastest = one;
  });
  return fastest;
}

double clearance_rate_mps(const Piece& a, const Piece& b, SimTime t, TimeSense sense) {
  double rate = std::numeric_limits<double>::infinity();
  const double sign = sense == TimeSense::Forward ? -1.0 : 1.0;
  for_nearest(a, b, t, [&](const RelativeSpeed& one) { rate = std::min(rate, sign * one.normal_mps); });
  return rate;
}

RelativeSpeed fastest_below(const Piece& a, const Piece& b, Interval within, double below_m, EvaluationCount& count) {
  return FastestInstant(a, b, below_m, count).within(within);
}

}  // namespace fleetproof
