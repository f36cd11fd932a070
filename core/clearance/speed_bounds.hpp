// Bounds on the speed of points that two bodies share: at an instant, and for a time in which no law of motion changes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/clearance/clearance_over_time.hpp"
#include "core/clearance/phase_motion.hpp"
#include "core/clearance/shared_points.hpp"

namespace fleetproof::shared_points {

// What says how fast the points may be that a body shares with another one, in the frame of the body.
struct Share {
  Vec2 half_m;        // half length and half width of the body
  Box other;          // around the other one
  Vec2 velocity_mps;  // of the body's centre, against what the other one does there
  double turning_rad_s;

  Share(const Meeting& meeting, const OrientedRectangle& body, const View& view)
      : half_m(body.half_length_m + kClearlyAway_m, body.half_width_m + kClearlyAway_m),
        other(view.box()),
        turning_rad_s(meeting.a.twist.turning_rad_s - meeting.b.twist.turning_rad_s) {
    const Vec2 velocity = meeting.closing_mps({body.centre_m, body.centre_m});
    velocity_mps = {velocity.dot(body.heading), cross(body.heading, velocity)};
  }

  // Of the body's corners, in its frame.
  Corners corner_velocities_mps() const {
    const double x = turning_rad_s * (half_m.x() - kClearlyAway_m), y = turning_rad_s * (half_m.y() - kClearlyAway_m);
    return {Vec2(velocity_mps.x() - y, velocity_mps.y() + x), Vec2(velocity_mps.x() - y, velocity_mps.y() - x),
            Vec2(velocity_mps.x() + y, velocity_mps.y() - x), Vec2(velocity_mps.x() + y, velocity_mps.y() + x)};
  }
  // No point of the body that lies in this box is faster.
  double most_mps(const Box& box) const {
    const Vec2 low = box.low_m.cwiseMax(-half_m), high = box.high_m.cwiseMin(half_m);
    const double along = std::max(std::abs(velocity_mps.x() - turning_rad_s * low.y()),
                                  std::abs(velocity_mps.x() - turning_rad_s * high.y())),
                 aside = std::max(std::abs(velocity_mps.y() + turning_rad_s * low.x()),
                                  std::abs(velocity_mps.y() + turning_rad_s * high.x()));
    return std::sqrt(along * along + aside * aside);
  }
};

// Two bodies at an instant, of which only bounds on their speeds are asked.
struct Glimpse {
  Views views;
  Share of_a, of_b;
  double a_turning_rad_s, b_turning_rad_s;
  double distance_m;  // of the centres

  Glimpse(const Meeting& meeting, const Views& both)
      : views(both),
        of_a(meeting, meeting.a.body, views.from_first),
        of_b(meeting, meeting.b.body, views.from_second),
        a_turning_rad_s(meeting.a.twist.turning_rad_s),
        b_turning_rad_s(meeting.b.twist.turning_rad_s),
        distance_m((meeting.b.body.centre_m - meeting.a.body.centre_m).norm()) {}

  // No point that both bodies share is faster.
  double most_mps() const { return std::min(of_a.most_mps(of_a.other), of_b.most_mps(of_b.other)); }
};

// Bounds on how a body moves, which hold for a time: on its centre, its rotation, and each of its points.
struct Tops {
  double radius_m;
  double mps, mps2, mps3;
  double rad_s, rad_s2, rad_s3;

  explicit Tops(const PhaseMotion& motion)
      : radius_m(Vec2(motion.body.half_length_m, motion.body.half_width_m).norm()),
        rad_s(motion.top_turning.rad_s),
        rad_s2(motion.top_turning.rad_s2),
        rad_s3(motion.top_turning.rad_s3) {
    const PointMotion centre = motion.point(Vec2::Zero());
    mps = centre.top_mps;
    mps2 = centre.top_mps2;
    mps3 = centre.top_mps3;
  }
  double point_mps() const { return mps + rad_s * radius_m; }
  double point_mps2() const { return mps2 + spin() * radius_m; }
  double spin() const { return rad_s2 + rad_s * rad_s; }
};

// Bounds on the second derivatives of a Share. In the frame of the body, whose rotation is w, a vector q of the floor
// has q'' - 2 w Jq' - w' Jq - w^2 q, where J is left_of.
struct Straying {
  double other_mps2;     // of the points of the other body
  double velocity_mps3;  // of the velocity of each point of the body

  // With the velocities v of the centres and the line d between them, the velocity is u = v - v_other - w_other Jd.
  Straying(const Tops& own, const Tops& other, double distance_m) {
    const double mps = own.mps + other.mps, mps2 = own.mps2 + other.mps2, u = mps + other.rad_s * distance_m,
                 u1 = mps2 + other.rad_s2 * distance_m + other.rad_s * mps,
                 u2 = own.mps3 + other.mps3 + other.rad_s3 * distance_m + 2.0 * other.rad_s2 * mps + other.rad_s * mps2;
    other_mps2 = own.mps2 + other.point_mps2() + 2.0 * own.rad_s * (own.mps + other.point_mps()) +
                 own.spin() * (distance_m + other.radius_m);
    velocity_mps3 = u2 + 2.0 * own.rad_s * u1 + own.spin() * u + (own.rad_s3 + other.rad_s3) * own.radius_m;
  }
};

// The corners of a body, at both ends of a time: where they are in the frame of the other body, and how fast they are
// against it, in their own frame. Between the ends, both stray from the straight line.
struct CornerTracks {
  std::array<Corners, 2> places_m, velocities_mps;
  std::array<const View*, 2> seen;
  std::array<double, 2> others_turning_rad_s;  // as it adds to the speed of the first body against the second
  double strays_m, strays_mps;                 // from the straight line
  double passing_mps;                          // in the frame of the other body
  double beside_mps2;                          // how fast `beside_mps` changes
  std::array<double, 4> most_mps{};
  Vec2 half_m;  // of the other body

  CornerTracks(const std::array<const Share*, 2>& own, const std::array<const View*, 2>& seen_so,
               const std::array<double, 2>& others_turning, const Vec2& others_half_m, const Straying& own_straying,
               const Straying& others_straying, const Tops& other, double lasts_s)
      : seen(seen_so), others_turning_rad_s(others_turning), half_m(others_half_m) {
    const double strays = 0.125 * lasts_s * lasts_s;
    strays_m = strays * others_straying.other_mps2;
    strays_mps = strays * own_straying.velocity_mps3;
    for (std::size_t end = 0; end < 2; ++end) {
      places_m[end] = seen[end]->corners();
      velocities_mps[end] = own[end]->corner_velocities_mps();
    }
    double way2_m2 = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      most_mps[i] =
          std::sqrt(std::max(velocities_mps[0][i].squaredNorm(), velocities_mps[1][i].squaredNorm())) + strays_mps;
      way2_m2 = std::max(way2_m2, (places_m[1][i] - places_m[0][i]).squaredNorm());
    }
    passing_mps = std::sqrt(way2_m2) / lasts_s + 0.5 * lasts_s * others_straying.other_mps2;
    beside_mps2 = 1.01 * (other.rad_s * passing_mps + kClearlyAway_m * (other.rad_s2 + other.rad_s * other.rad_s));
  }

  // What the speed of a corner outside of the other body differs by from the speed of its nearest point there, at an
  // end of the time, in its own body's frame.
  Vec2 beside_mps(std::size_t i, std::size_t end) const {
    const Vec2 half = half_m - Vec2::Constant(kClearlyAway_m), place = places_m[end][i],
               gap = place - place.cwiseMax(-half).cwiseMin(half);
    return others_turning_rad_s[end] * left_of(seen[end]->in_other(gap));
  }
  // Whether the corner may come into the other body in this time.
  bool may_come_in(std::size_t i) const {
    const Vec2 low = places_m[0][i].cwiseMin(places_m[1][i]), high = places_m[0][i].cwiseMax(places_m[1][i]);
    return low.x() - strays_m <= half_m.x() && high.x() + strays_m >= -half_m.x() && low.y() - strays_m <= half_m.y() &&
           high.y() + strays_m >= -half_m.y();
  }
  // Whether it is clearly in there all the time.
  bool stays_inside(std::size_t i) const {
    const Vec2 farthest = places_m[0][i].cwiseAbs().cwiseMax(places_m[1][i].cwiseAbs());
    const double margin_m = strays_m + 3.0 * kClearlyAway_m;
    return farthest.x() <= half_m.x() - margin_m && farthest.y() <= half_m.y() - margin_m;
  }
};

// Whether points that two bodies share in a time may be as fast as a limit. The corners of what they share are followed
// one by one: corners of the bodies, and crossings of their sides. The time lies in one phase.
class SharedTracks {
 public:
  // The end of the time at which the speed reaches the limit, if there is one. This instant itself may be as fast.
  enum class Peak { None, Begin, End };

  // Requires: both glimpses outlive the object.
  SharedTracks(const Glimpse& from, const Glimpse& to, const Tops& of_a, const Tops& of_b, double lasts_s)
      : lasts_s_(lasts_s),
        strays_(0.125 * lasts_s * lasts_s),
        distance_m_(std::max(from.distance_m, to.distance_m) + 0.5 * lasts_s * (of_a.mps + of_b.mps)),
        straying_a_(of_a, of_b, distance_m_),
        straying_b_(of_b, of_a, distance_m_),
        a_({&from.of_a, &to.of_a}, {&from.views.from_second, &to.views.from_second},
           {from.b_turning_rad_s, to.b_turning_rad_s}, from.of_b.half_m, straying_a_, straying_b_, of_b, lasts_s),
        b_({&from.of_b, &to.of_b}, {&from.views.from_first, &to.views.from_first},
           {-from.a_turning_rad_s, -to.a_turning_rad_s}, from.of_a.half_m, straying_b_, straying_a_, of_a, lasts_s),
        turning_rad_s_(of_a.rad_s + of_b.rad_s),
        turning_rad_s2_(of_a.rad_s2 + of_b.rad_s2),
        turning_rad_s3_(of_a.rad_s3 + of_b.rad_s3),
        slack_mps_(kClearlyAway_m * turning_rad_s_ + kRounding_mps) {
    spin_rad_s_ =
        std::min(turning_rad_s_, std::max(std::abs(from.of_a.turning_rad_s), std::abs(to.of_a.turning_rad_s)) +
                                     strays_ * turning_rad_s3_ + kRounding_mps);
  }

  bool all_slower(double limit_mps, Peak peak = Peak::None) const {
    for (std::size_t i = 0; i < 4; ++i) {
      if (!is_slower(a_, i, straying_a_, limit_mps, peak) || !is_slower(b_, i, straying_b_, limit_mps, peak))
        return false;
    }
    for (std::size_t i = 0; i < 4; ++i) {
      const double side_mps = std::max(a_.most_mps[i], a_.most_mps[(i + 1) % 4]) + slack_mps_;
      if (side_mps < limit_mps) continue;
      for (std::size_t j = 0; j < 4; ++j) {
        if (std::max(b_.most_mps[j], b_.most_mps[(j + 1) % 4]) + slack_mps_ < limit_mps) continue;
        if (!crossing_is_slower(i, j, limit_mps, peak)) return false;
      }
    }
    return true;
  }

 private:
  static constexpr double kLeastSine = 0.1;  // sides that are nearly parallel may cross anywhere

  bool is_slower(const CornerTracks& tracks, std::size_t i, const Straying& straying, double limit_mps,
                 Peak peak) const {
    if (tracks.most_mps[i] + slack_mps_ < limit_mps || !tracks.may_come_in(i)) return true;
    if (peak == Peak::None) return false;
    // The speed counts against the nearest point of the other body, which is the corner itself unless it is outside.
    const bool inside = tracks.stays_inside(i);
    const Vec2 beside_mps = inside ? Vec2(Vec2::Zero()) : tracks.beside_mps(i, peak == Peak::Begin ? 0 : 1);
    return falls({tracks.velocities_mps[0][i] + beside_mps, tracks.velocities_mps[1][i] + beside_mps},
                 straying.velocity_mps3, tracks.most_mps[i] + slack_mps_, inside ? 0.0 : tracks.beside_mps2, limit_mps,
                 peak);
  }

  // Whether the speed of a point falls from the peak on, which is not above the limit. The square of the speed has a
  // second derivative that is no less than -2 most * mps3, so it lies above the straight line between its ends by no
  // more than most * mps3 times the times to both ends. A corner that may be outside has `beside_mps2` to add.
  bool falls(const std::array<Vec2, 2>& velocities_mps, double mps3, double most_mps, double beside_mps2,
             double limit_mps, Peak peak) const {
    constexpr double kSameSquare = 1e-13, kLeastFall = 0.05;
    if (peak == Peak::None) return false;
    double low = velocities_mps[0].squaredNorm(), high = velocities_mps[1].squaredNorm();
    if (peak == Peak::Begin) std::swap(low, high);
    if (high > limit_mps * limit_mps * (1.0 + kSameSquare)) return false;
    return (high - low) / lasts_s_ - most_mps * mps3 * lasts_s_ -
               2.0 * (most_mps + beside_mps2 * lasts_s_) * beside_mps2 >
           kLeastFall * (1.0 + limit_mps * limit_mps);
  }

  // Of a side of the first body and a side of the second one. In the frame of the second body, the first side lies
  // across the line of the other side: with the distance n of its corner from that line, and the sine of the angle
  // between them, the crossing is n / sine along the first side.
  bool crossing_is_slower(std::size_t i, std::size_t j, double limit_mps, Peak peak) const {
    const std::size_t next = (i + 1) % 4, axis = j % 2 == 0 ? 1 : 0, along = 1 - axis;
    const auto ax = static_cast<Eigen::Index>(axis), al = static_cast<Eigen::Index>(along);
    const double line_m = (j == 0 || j == 3 ? 1.0 : -1.0) * (b_half(ax)), side_m = a_side_m(i);
    std::array<double, 2> place_m, sine, n_m, at_m;
    std::array<Vec2, 2> velocity_mps;
    double nearest_m = 1e300, farthest_m = -1e300;
    for (std::size_t end = 0; end < 2; ++end) {
      n_m[end] = a_.places_m[end][i][ax] - line_m;
      const double next_m = a_.places_m[end][next][ax] - line_m;
      nearest_m = std::min({nearest_m, n_m[end], next_m});
      farthest_m = std::max({farthest_m, n_m[end], next_m});
      sine[end] = (next_m - n_m[end]) / side_m;
    }
    const double away_m = a_.strays_m + kClearlyAway_m;
    if (nearest_m > away_m || farthest_m < -away_m) return true;
    const double bends = spin_rad_s_ * spin_rad_s_ + turning_rad_s2_,
                 least_sine = std::min(std::abs(sine[0]), std::abs(sine[1])) - strays_ * bends;
    if (sine[0] * sine[1] <= 0.0 || least_sine < kLeastSine) return false;
    for (std::size_t end = 0; end < 2; ++end) {
      place_m[end] = -n_m[end] / sine[end];
      const double share = place_m[end] / side_m;
      at_m[end] = a_.places_m[end][i][al] + share * (a_.places_m[end][next][al] - a_.places_m[end][i][al]);
      velocity_mps[end] =
          a_.velocities_mps[end][i] + share * (a_.velocities_mps[end][next] - a_.velocities_mps[end][i]);
    }
    const double mps2 = straying_b_.other_mps2,
                 most_m = (std::max(std::abs(n_m[0]), std::abs(n_m[1])) + a_.strays_m) / least_sine,
                 most_mps = (a_.passing_mps + most_m * spin_rad_s_) / least_sine,
                 turns_mps2 = mps2 + 2.0 * most_mps * spin_rad_s_ + most_m * bends, most_mps2 = turns_mps2 / least_sine;
    const double slides_m = strays_ * most_mps2 + kClearlyAway_m;
    if (std::min(place_m[0], place_m[1]) > side_m + slides_m || std::max(place_m[0], place_m[1]) < -slides_m)
      return true;
    const double reach_m = b_half(al) + strays_ * (turns_mps2 + most_mps2) + kClearlyAway_m;
    if (std::min(at_m[0], at_m[1]) > reach_m || std::max(at_m[0], at_m[1]) < -reach_m) return true;
    const double mps3 = straying_a_.velocity_mps3 + turning_rad_s3_ * most_m + 2.0 * turning_rad_s2_ * most_mps +
                        spin_rad_s_ * most_mps2;
    const double speed_mps =
        std::sqrt(std::max(velocity_mps[0].squaredNorm(), velocity_mps[1].squaredNorm())) + strays_ * mps3;
    if (speed_mps + slack_mps_ < limit_mps) return true;
    return falls(velocity_mps, mps3, speed_mps, 0.0, limit_mps, peak);
  }

  double b_half(Eigen::Index axis) const { return a_.half_m[axis] - kClearlyAway_m; }
  double a_side_m(std::size_t i) const { return 2.0 * (b_.half_m[i % 2 == 0 ? 0 : 1] - kClearlyAway_m); }

  double lasts_s_, strays_, distance_m_;
  Straying straying_a_, straying_b_;
  CornerTracks a_, b_;
  double turning_rad_s_, turning_rad_s2_, turning_rad_s3_, slack_mps_, spin_rad_s_;
};

// Of two bodies that overlap, the points that may be the fastest within a time before and after an instant. Each corner
// and each crossing has a speed at the instant, and gains no more than its acceleration allows.
class FastCandidates {
 public:
  SharedCandidates fast;
  double others_mps = 0.0;  // no other point that both share is faster in this time
  bool overlap = false;     // both overlap all the time

  FastCandidates(const Meeting& at, const Tops& of_a, const Tops& of_b, double time_s, double fastest_mps)
      : of_first_(corners(at.a.body)), of_second_(corners(at.b.body)), time_s_(time_s + kNanosecond_s) {
    const double distance_m = (at.b.body.centre_m - at.a.body.centre_m).norm() + time_s_ * (of_a.mps + of_b.mps);
    turning_rad_s_ = of_a.rad_s + of_b.rad_s;
    // A point of one body moves so fast in the frame of the other one.
    passing_mps_ = of_a.point_mps() + of_b.point_mps() + of_a.rad_s * (distance_m + of_b.radius_m) +
                   of_b.rad_s * (distance_m + of_a.radius_m);
    const double gain_a = gain_mps(of_a, of_b, distance_m), gain_b = gain_mps(of_b, of_a, distance_m);
    least_mps_ = fastest_mps - 2.0 * std::max(gain_a, gain_b);
    for (std::size_t i = 0; i < 4; ++i) {
      first_mps_[i] = at.closing_mps({of_first_[i], of_first_[i]}).norm() + gain_a;
      second_mps_[i] = at.closing_mps({of_second_[i], of_second_[i]}).norm() + gain_b;
    }
    const double near_m = passing_mps_ * time_s_ + kClearlyAway_m;
    overlap = clearance_m(at.a.body, at.b.body) < -near_m;
    const Views views(at.a.body, at.b.body);
    const unsigned first_inside = views.from_second.corners_inside(near_m),
                   second_inside = views.from_first.corners_inside(near_m);
    for (unsigned i = 0; i < 4; ++i) {
      if ((first_inside >> i & 1U) != 0 && may_be_fast(first_mps_[i])) fast.of_first |= 1U << i;
      if ((second_inside >> i & 1U) != 0 && may_be_fast(second_mps_[i])) fast.of_second |= 1U << i;
      for (unsigned j = 0; j < 4; ++j) {
        if (may_be_fast(crossing_mps(at, i, j, gain_a))) fast.crossings[i] |= 1U << j;
      }
    }
  }

 private:
  static constexpr double kNanosecond_s = 1e-9;  // phases end at whole nanoseconds
  static constexpr double kLeastSine = 0.01;     // sides that are nearly parallel may cross anywhere

  // What a point of a body gains in this time, at most, against the other body.
  double gain_mps(const Tops& own, const Tops& other, double distance_m) const {
    return time_s_ * (own.point_mps2() + other.mps2 + other.rad_s2 * (distance_m + own.radius_m) +
                      other.rad_s * (own.point_mps() + other.mps)) +
           kRounding_mps;
  }
  bool may_be_fast(double most_mps) {
    if (most_mps >= least_mps_) return true;
    others_mps = std::max(others_mps, most_mps);
    return false;
  }
  // No crossing of these sides is faster. 0: they do not cross. It slides along a side at (n' + s w) / sine, where n'
  // is the speed of the side's end across the other side, s the place on the side and w the turning.
  double crossing_mps(const Meeting& at, std::size_t i, std::size_t j, double gain_a) const {
    const Vec2 side = of_first_[(i + 1) % 4] - of_first_[i], other = of_second_[(j + 1) % 4] - of_second_[j],
               between = of_second_[j] - of_first_[i];
    const double of_ends_mps =
        std::min(std::max(first_mps_[i], first_mps_[(i + 1) % 4]), std::max(second_mps_[j], second_mps_[(j + 1) % 4]));
    const double side_m = side.norm(), other_m = other.norm(), product = cross(side, other),
                 least_sine = std::abs(product) / (side_m * other_m) - turning_rad_s_ * time_s_;
    if (least_sine < kLeastSine) return of_ends_mps;
    const auto slides_m = [&](double length_m) {
      return time_s_ * (passing_mps_ + 2.0 * length_m * turning_rad_s_) / least_sine + kClearlyAway_m;
    };
    const double here_slides_m = slides_m(side_m), there_slides_m = slides_m(other_m);
    if (here_slides_m > side_m || there_slides_m > other_m) return of_ends_mps;
    const double here_m = side_m * cross(between, other) / product, there_m = other_m * cross(between, side) / product;
    if (here_m < -here_slides_m || here_m > side_m + here_slides_m || there_m < -there_slides_m ||
        there_m > other_m + there_slides_m)
      return 0.0;
    const Vec2 point = of_first_[i] + std::clamp(here_m / side_m, 0.0, 1.0) * side;
    return std::min(of_ends_mps, at.closing_mps({point, point}).norm() + turning_rad_s_ * here_slides_m + gain_a);
  }

  Corners of_first_, of_second_;
  std::array<double, 4> first_mps_, second_mps_;
  double time_s_, turning_rad_s_, passing_mps_, least_mps_;
};

// How fast the fastest point of a body may be.
class Pace {
 public:
  explicit Pace(const Piece& piece) : piece_(piece) {
    const double reach_m = piece.footprint.reach_m() + kClearlyAway_m;
    if (piece.manner == Manner::Turn) times_speed_ = reach_m;
    if (piece.manner != Manner::Drive) return;
    double bending_per_m = 0.0;
    for (const CurvePart& part : piece.curve->parts()) bending_per_m = std::max(bending_per_m, part.most().per_m);
    times_speed_ = 1.0 + bending_per_m * reach_m;
  }

  // The speed changes evenly within each phase of the profile.
  double most_mps(Interval within) const {
    if (times_speed_ == 0.0) return 0.0;
    double most = std::max(speed(within.begin), speed(within.end));
    for (const Duration end : piece_.profile.phase_ends()) {
      const SimTime t = piece_.begin + end;
      if (within.begin < t && t < within.end) most = std::max(most, speed(t));
    }
    return times_speed_ * most;
  }

 private:
  double speed(SimTime t) const {
    return piece_.profile.speed(to_seconds(std::clamp(t, piece_.begin, piece_.end) - piece_.begin));
  }

  const Piece& piece_;
  double times_speed_ = 0.0;  // metres for a turn, whose speed is an angle's; 0: at rest
};

}  // namespace fleetproof::shared_points
