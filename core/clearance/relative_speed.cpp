#include "core/clearance/relative_speed.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/tolerances.hpp"
#include "core/geometry/rectangle.hpp"

namespace fleetproof {
namespace {

// A point of each of two bodies, both on the floor.
struct PointPair {
  Vec2 on_first, on_second;
};

using Corners = std::array<Vec2, 4>;

// In this order: front left, rear left, rear right, front right. A side begins at the corner with its number: left,
// rear, right, front.
Corners corners(const OrientedRectangle& body) {
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

// A bound on a speed is worked out in another way than the speed. The difference by rounding is far below this.
constexpr double kRounding_mps = 1e-9;

// What a view leaves out is farther away than this, which is far beyond its rounding.
constexpr double kClearlyAway_m = 1e-6;

// A rectangle as seen from the frame of another one. It selects what is then worked out exactly.
class View {
 public:
  View(const OrientedRectangle& from, const OrientedRectangle& other)
      : half_length_m_(from.half_length_m + kClearlyAway_m), half_width_m_(from.half_width_m + kClearlyAway_m) {
    const double cosine = from.heading.dot(other.heading), sine = cross(from.heading, other.heading);
    const Vec2 offset = other.centre_m - from.centre_m;
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
  double x_, y_;                                    // the centre of the other one
  double length_x_, length_y_, width_x_, width_y_;  // its half length and half width
};

// Points of two rectangles that may be corners of what they share: corners of each, a bit each; and for each side of
// the first one, the sides of the second one that may cross it, a bit each.
struct Candidates {
  unsigned of_first = 0, of_second = 0;
  std::array<unsigned, 4> crossings{};
};

// The two rectangles of a pair, each as seen from the other one.
struct Views {
  View from_first, from_second;

  Candidates candidates() const {
    Candidates found{from_second.corners_inside(), from_first.corners_inside(), from_second.lines_crossed()};
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

// The points at which two rectangles are nearest. If a whole edge is nearest, both of its ends. If the rectangles
// overlap, the corners of what they share; both points of such a pair are the same. Never empty.
class NearestPoints {
 public:
  // Of two that are apart.
  NearestPoints(const OrientedRectangle& first, const OrientedRectangle& second) {
    for (const Vec2& corner : corners(first)) add({corner, nearest_point_of(second, corner)});
    for (const Vec2& corner : corners(second)) add({nearest_point_of(first, corner), corner});
    double least_m = std::numeric_limits<double>::infinity();
    for (const PointPair& pair : *this) least_m = std::min(least_m, gap_m(pair));
    const auto farther = [&](const PointPair& pair) { return gap_m(pair) > least_m + kEquallyNear_m; };
    count_ = static_cast<std::size_t>(std::remove_if(pairs_.data(), pairs_.data() + count_, farther) - pairs_.data());
  }
  // Of two that overlap.
  NearestPoints(const OrientedRectangle& first, const OrientedRectangle& second, const Candidates& candidates) {
    const Corners of_first = corners(first), of_second = corners(second);
    for (unsigned left = candidates.of_first; left != 0; left &= left - 1) {
      const Vec2& corner = of_first[static_cast<std::size_t>(std::countr_zero(left))];
      add_shared({corner, nearest_point_of(second, corner)});
    }
    for (unsigned left = candidates.of_second; left != 0; left &= left - 1) {
      const Vec2& corner = of_second[static_cast<std::size_t>(std::countr_zero(left))];
      add_shared({nearest_point_of(first, corner), corner});
    }
    for (std::size_t i = 0; i < 4; ++i) {
      for (unsigned left = candidates.crossings[i]; left != 0; left &= left - 1)
        add_crossing(of_first, i, of_second, static_cast<std::size_t>(std::countr_zero(left)));
    }
  }

  const PointPair* begin() const { return pairs_.data(); }
  const PointPair* end() const { return pairs_.data() + count_; }

 private:
  static double gap_m(const PointPair& pair) { return (pair.on_second - pair.on_first).norm(); }

  void add(const PointPair& pair) { pairs_[count_++] = pair; }
  void add_shared(const PointPair& pair) {
    if (gap_m(pair) <= kEquallyNear_m) add(pair);
  }
  // Where two sides cross. Parallel sides share corners, or nothing.
  void add_crossing(const Corners& first, std::size_t i, const Corners& second, std::size_t j) {
    const Vec2 side = first[(i + 1) % 4] - first[i], other = second[(j + 1) % 4] - second[j],
               between = second[j] - first[i];
    const double sine = cross(side, other);
    if (std::abs(sine) <= kAlongSide * side.norm() * other.norm()) return;
    const double here = cross(between, other) / sine, there = cross(between, side) / sine;
    if (here < 0.0 || here > 1.0 || there < 0.0 || there > 1.0) return;
    const Vec2 at = first[i] + here * side;
    add({at, at});
  }

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

Moment moment_of(const Piece& piece, SimTime t) {
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
  double highest_mps(const NearestPoints& pairs) const {
    double square = 0.0;
    for (const PointPair& pair : pairs) square = std::max(square, closing_mps(pair).squaredNorm());
    return std::sqrt(square);
  }
};

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
  Share of_a, of_b;
  double distance_m;  // of the centres

  Glimpse(const Meeting& meeting, const Views& views)
      : of_a(meeting, meeting.a.body, views.from_first),
        of_b(meeting, meeting.b.body, views.from_second),
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

// Of two bodies that overlap, the points that may be the fastest within a time before and after an instant. Each corner
// and each crossing has a speed at the instant, and gains no more than its acceleration allows.
class FastCandidates {
 public:
  Candidates fast;
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

// The relative speed of every pair of nearest points.
template <class Visit>
void for_nearest(const Piece& a, const Piece& b, SimTime t, const Visit& visit) {
  const Meeting meeting(a, b, t);
  const auto [clearance, normal] = separation(meeting.a.body, meeting.b.body);
  for (const PointPair& pair : meeting.nearest(clearance <= 0.0)) {
    const Vec2 closing_mps = meeting.closing_mps(pair);
    visit(RelativeSpeed{closing_mps.norm(), closing_mps.dot(normal)});
  }
}

// Bodies in contact move on for seconds, so that there are hundreds of instants to look at. Bounds on what the bodies
// share, and on how that changes, say which of them cannot be the fastest.
class FastestInstant {
 public:
  FastestInstant(const Piece& a, const Piece& b, double below_m, EvaluationCount& count, double matters_from_mps)
      : a_(a), b_(b), pace_a_(a), pace_b_(b), below_m_(below_m), count_(count), matters_from_mps_(matters_from_mps) {}

  RelativeSpeed within(Interval all) {
    if (a_.manner == Manner::Rest && b_.manner == Manner::Rest) return {};
    if (pace_a_.most_mps(all) + pace_b_.most_mps(all) + kRounding_mps < matters_from_mps_) return {};
    split(all);
    samples_.reserve(256);
    samples_.push_back({all.begin, all});
    for (Phase& phase : phases_) add_samples(phase);
    choose(matters_from_mps_);
    if (fastest_mps_ < matters_from_mps_) {
      if (!may_matter_) return {};
      choose(0.0);
    }
    if (fastest_mps_ >= matters_from_mps_ || may_matter_) narrow();
    return fastest_mps_ > 0.0 ? relative_speed(a_, b_, fastest_at_) : RelativeSpeed{};
  }

 private:
  static constexpr std::size_t kFew = 8;
  struct Sample {
    SimTime t;
    Interval around;  // its neighbours
  };
  // A time in which neither law of motion changes.
  struct Phase {
    Interval time;
    Tops of_a, of_b;
    double most_mps;                  // no pair of nearest points is faster, whatever the places of the bodies
    std::size_t first = 0, last = 0;  // the samples inside; one more is at the end
  };

  void split(Interval all) {
    for (SimTime t = all.begin; t < all.end;) {
      const PhaseMotion of_a = motion_from(a_, a_.body_at(t), t, all.end, TimeSense::Forward),
                        of_b = motion_from(b_, b_.body_at(t), t, all.end, TimeSense::Forward);
      const Interval time{t, std::max(t + Duration{1}, std::min({of_a.change, of_b.change, all.end}))};
      const double most_mps = pace_a_.most_mps(time) + pace_b_.most_mps(time) + kRounding_mps;
      phases_.push_back({time, Tops(of_a), Tops(of_b), most_mps});
      t = time.end;
    }
  }

  // Without rotation, the relative speed between two changes is largest at one of them. An arc ends in a step of the
  // turning rate: both sides of a change count.
  void add_samples(Phase& phase) {
    constexpr int kSamples = 64;
    const auto [begin, end] = phase.time;
    const bool steady = a_.keeps_heading() && b_.keeps_heading();
    const Duration step = std::max((end - begin) / (steady ? 1 : kSamples), Duration{1});
    const auto add = [&](SimTime t) {
      samples_.push_back({t, {std::max(phase.time.begin, t - step), std::min(phase.time.end, t + step)}});
    };
    phase.first = samples_.size();
    for (SimTime t = begin + Duration{1}; t < end; t += step) add(t);
    phase.last = samples_.size();
    add(end - Duration{1});
    add(end);
  }

  // The fastest sample; of equals, the earliest. What is left out between two samples is slower than another sample, or
  // than `from_mps`.
  void choose(double from_mps) {
    std::vector<std::pair<Glimpse, Glimpse>> ends;
    consider(0);
    for (const Phase& phase : phases_) {
      if (phase.most_mps < from_mps) continue;
      const Glimpse at_first = consider(phase.first);
      ends.emplace_back(at_first, consider(phase.last));
      consider(phase.last + 1);
    }
    auto at_ends = ends.begin();
    for (const Phase& phase : phases_) {
      if (phase.most_mps < from_mps) continue;
      choose_between(phase, phase.first, at_ends->first, phase.last, at_ends->second, from_mps);
      ++at_ends;
    }
  }

  void choose_between(const Phase& phase, std::size_t first, const Glimpse& at_first, std::size_t last,
                      const Glimpse& at_last, double from_mps) {
    const double most = most_mps(phase, at_first, at_last, to_seconds(samples_[last].t - samples_[first].t));
    if (most < std::max(fastest_mps_, from_mps)) return;
    if (last - first <= kFew) {
      may_matter_ = may_matter_ || most >= matters_from_mps_;
      if (last - first < 2) return;
      look_at(phase, {samples_[first].t, samples_[last].t});
      for (std::size_t i = first + 1; i < last; ++i) offer(i, speed_at(samples_[i].t));
      return;
    }
    const std::size_t middle = (first + last) / 2;
    const Glimpse at_middle = consider(middle);
    choose_between(phase, first, at_first, middle, at_middle, from_mps);
    choose_between(phase, middle, at_middle, last, at_last, from_mps);
  }

  // Between two instants of a phase, no point that both bodies share is faster.
  double most_mps(const Phase& phase, const Glimpse& from, const Glimpse& to, double lasts_s) const {
    if (below_m_ > kTouch_m) return std::numeric_limits<double>::infinity();
    const Tops &of_a = phase.of_a, &of_b = phase.of_b;
    const double half_s = 0.5 * lasts_s, strays = 0.5 * half_s * half_s,
                 distance_m = std::max(from.distance_m, to.distance_m) + half_s * (of_a.mps + of_b.mps);
    const auto most = [&](const Share& one, const Share& other, const Straying& straying) {
      Box box = one.other;
      box.add(other.other);
      box = box.grown(strays * straying.other_mps2);
      return std::max(one.most_mps(box), other.most_mps(box)) + strays * straying.velocity_mps3;
    };
    return std::min(most(from.of_a, to.of_a, Straying(of_a, of_b, distance_m)),
                    most(from.of_b, to.of_b, Straying(of_b, of_a, distance_m))) +
           kClearlyAway_m * (of_a.rad_s + of_b.rad_s) + kRounding_mps;
  }

  Glimpse consider(std::size_t number) {
    const Sample& sample = samples_[number];
    ++count_.distance;
    const Meeting meeting(a_, b_, sample.t);
    const Views views(meeting.a.body, meeting.b.body);
    const Glimpse glimpse(meeting, views);
    offer(number, speed_of(meeting, views, glimpse));
    return glimpse;
  }

  void offer(std::size_t number, double here_mps) {
    if (here_mps == 0.0 || here_mps < fastest_mps_ || (here_mps == fastest_mps_ && number >= fastest_)) return;
    fastest_mps_ = here_mps;
    fastest_ = number;
    fastest_at_ = samples_[number].t;
  }

  // Of the fastest pair of nearest points. 0 if the clearance is not below the limit, or if no pair can be as fast as
  // the fastest so far.
  double speed_of(const Meeting& meeting, const Views& views, const Glimpse& glimpse) const {
    const double clearance = clearance_m(meeting.a.body, meeting.b.body);
    if (clearance >= below_m_) return 0.0;
    if (clearance > 0.0) return meeting.highest_mps(NearestPoints(meeting.a.body, meeting.b.body));
    if (fastest_mps_ > 0.0 && glimpse.most_mps() + kRounding_mps < fastest_mps_) return 0.0;
    return meeting.highest_mps(NearestPoints(meeting.a.body, meeting.b.body, views.candidates()));
  }

  // To the nanosecond, between the neighbours of the fastest sample.
  void narrow() {
    if ((a_.keeps_heading() && b_.keeps_heading()) || fastest_mps_ == 0.0) return;
    constexpr int kRounds = 8;
    Interval left = samples_[fastest_].around;
    for (int i = 0; left.end - left.begin > Duration{2}; ++i) {
      if (i % kRounds == 0) look_at(left);
      const Duration third = (left.end - left.begin) / 3;
      const SimTime low = left.begin + third, high = left.end - third;
      if (is_slower(low, high)) {
        left.begin = low;
      } else {
        left.end = high;
      }
    }
  }

  // Whether the first of two instants is the slower one; both are offered.
  bool is_slower(SimTime low, SimTime high) {
    const double low_mps = speed_at(low), high_mps = speed_at(high);
    offer(low, low_mps);
    offer(high, high_mps);
    return low_mps < high_mps;
  }

  double speed_at(SimTime t) {
    ++count_.distance;
    const Meeting meeting(a_, b_, t);
    const bool overlaps = candidates_ && candidates_->overlap;
    const double clearance = overlaps ? 0.0 : clearance_m(meeting.a.body, meeting.b.body);
    if (clearance <= 0.0 && candidates_) {
      const double speed_mps = meeting.highest_mps(NearestPoints(meeting.a.body, meeting.b.body, candidates_->fast));
      if (speed_mps > candidates_->others_mps) return speed_mps;
    }
    return clearance >= below_m_ ? 0.0 : meeting.highest_mps(meeting.nearest(clearance <= 0.0));
  }

  // Sets the candidates between two instants.
  void look_at(Interval window) {
    candidates_.reset();
    for (const Phase& phase : phases_) {
      if (window.begin >= phase.time.begin && window.end <= phase.time.end) return look_at(phase, window);
    }
  }
  void look_at(const Phase& phase, Interval window) {
    const SimTime middle = window.begin + (window.end - window.begin) / 2;
    candidates_.emplace(Meeting(a_, b_, middle), phase.of_a, phase.of_b, to_seconds(window.end - middle), fastest_mps_);
  }

  void offer(SimTime t, double here_mps) {
    if (here_mps <= fastest_mps_) return;
    fastest_mps_ = here_mps;
    fastest_at_ = t;
  }

  const Piece& a_;
  const Piece& b_;
  Pace pace_a_, pace_b_;
  double below_m_;
  EvaluationCount& count_;
  double matters_from_mps_;
  std::vector<Phase> phases_;
  std::vector<Sample> samples_;
  double fastest_mps_ = 0.0;
  std::size_t fastest_ = 0;  // the number of that sample
  SimTime fastest_at_ = kStart;
  std::optional<FastCandidates> candidates_;
  bool may_matter_ = false;  // some instant may be faster than all samples, and as fast as matters
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

RelativeSpeed fastest_below(const Piece& a, const Piece& b, Interval within, double below_m, EvaluationCount& count,
                            double matters_from_mps) {
  return FastestInstant(a, b, below_m, count, matters_from_mps).within(within);
}

}  // namespace fleetproof
