#include "core/clearance/gap_bound.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "core/base/tolerances.hpp"
#include "core/geometry/rotation.hpp"

namespace fleetproof {
namespace {

constexpr double kFlattest_per_m = 1e-3;
constexpr double kNotMet = std::numeric_limits<double>::infinity();

// Least positive root of value + rate * x + bend * x^2 / 2, for a positive value.
double first_root(double value, double rate, double bend) {
  const double square = rate * rate - 2.0 * bend * value;
  if (rate < 0.0) return square < 0.0 ? kNotMet : 2.0 * value / (std::sqrt(square) - rate);
  return bend < 0.0 ? (rate + std::sqrt(square)) / -bend : kNotMet;
}

// From the centre.
std::array<Vec2, 4> corner_arms(const OrientedRectangle& body) {
  const Vec2 along = body.half_length_m * body.heading, aside = body.half_width_m * left_of(body.heading);
  return {along + aside, aside - along, -along - aside, along - aside};
}

Vec2 foremost_corner(const OrientedRectangle& body, const Vec2& direction) {
  const double ahead = direction.dot(body.heading) < 0.0 ? -body.half_length_m : body.half_length_m;
  const double beside = cross(body.heading, direction) < 0.0 ? -body.half_width_m : body.half_width_m;
  return ahead * body.heading + beside * left_of(body.heading);
}

// How far a corner reaches from the centre along a direction fixed to the floor, and how that changes with the
// corner's motion.
struct Reach {
  double value, rate, bend;
  double loss, most;  // a third of the bound on the third derivative; the bound on the second
};

// On a Bezier curve, the lever of a corner also changes with the curvature. `arm_beside` is the part along the
// direction of the arm (from the reference point) turned left.
void add_change_of_curvature(const PhaseMotion& motion, double arm_beside, Reach& reach) {
  const double ahead_m = motion.body.half_length_m + std::abs(motion.centre_ahead_m),
               arm_m = std::sqrt(ahead_m * ahead_m + motion.body.half_width_m * motion.body.half_width_m);
  reach.bend += motion.bending * motion.speed * motion.speed * arm_beside;
  reach.loss += (motion.per_arm.lever * motion.top_jerk + motion.per_arm.mps3) * arm_m / 3.0;
  reach.most += (motion.per_arm.lever * motion.top_acceleration + motion.per_arm.mps2) * arm_m;
}

// The corners that can be the foremost along a direction while the phase lasts.
struct Reaches {
  std::array<Reach, 4> of;
  std::size_t count = 0;

  Reaches(const PhaseMotion& motion, const Vec2& direction) {
    const OrientedRectangle& body = motion.body;
    const double ahead = direction.dot(body.heading), beside = cross(body.heading, direction);
    if (!motion.rotates()) {
      const double value = body.half_length_m * std::abs(ahead) + body.half_width_m * std::abs(beside);
      of[count++] = {value, motion.speed * ahead, motion.acceleration * ahead, 0.0, motion.top_acceleration};
      return;
    }
    // In the body's own frame: the corner at (x, y) has a lever there, and is pulled square to it.
    const double k = motion.curvature, pull = k * motion.speed * motion.speed;
    for (const auto& [x, y] :
         {std::pair{body.half_length_m, body.half_width_m}, std::pair{-body.half_length_m, body.half_width_m},
          std::pair{-body.half_length_m, -body.half_width_m}, std::pair{body.half_length_m, -body.half_width_m}}) {
      const double arm_x = x + motion.centre_ahead_m;
      const double lever_x = motion.turns_on_spot ? -y : 1.0 - k * y,
                   lever_y = motion.turns_on_spot ? arm_x : k * arm_x;
      const double along = lever_x * ahead + lever_y * beside, square = lever_x * beside - lever_y * ahead;
      const double length = std::sqrt(lever_x * lever_x + lever_y * lever_y);
      of[count] = {x * ahead + y * beside, motion.speed * along, motion.acceleration * along + pull * square,
                   length * motion.top_jerk / 3.0, length * motion.top_acceleration};
      if (motion.varies) add_change_of_curvature(motion, arm_x * beside - y * ahead, of[count]);
      ++count;
    }
  }
};

// The most that turning (at a rate, with its first two derivatives) can give a lever of length 1: its second
// derivative, its third.
struct TurningBound {
  double second, third;
  TurningBound(double rad_s, double rad_s2, double rad_s3) {
    const double w2 = rad_s * rad_s, a2 = rad_s2 * rad_s2;
    second = std::sqrt(a2 + w2 * w2);
    third = std::abs(rad_s) * std::sqrt(9.0 * a2 + w2 * w2) + rad_s3;
  }
};

bool is_side(const Vec2& direction, const OrientedRectangle& body) {
  return std::min(std::abs(direction.dot(body.heading)), std::abs(cross(body.heading, direction))) < kAlongSide;
}

// A pivot that is farther away bounds nothing.
bool has_pivot(const PhaseMotion& motion) { return !motion.varies || std::abs(motion.curvature) > kFlattest_per_m; }

Vec2 into_frame(const Vec2& direction, const Vec2& heading) {
  return {direction.dot(heading), cross(heading, direction)};
}

}  // namespace

Axis::Axis(const Separation& apart, const PhaseMotion& first, const PhaseMotion& second) : local_(apart.direction) {
  const bool first_side = is_side(apart.direction, first.body), second_side = is_side(apart.direction, second.body);
  if (first_side || second_side) {
    const bool floor = (first_side && !first.rotates()) || (second_side && !second.rotates());
    tie_ = floor ? Tie::Floor : first_side ? Tie::First : Tie::Second;
  } else if (first.rotates() || second.rotates()) {
    tie_ = tie_between_corners(apart, first, second);
  }
  if (tie_ != Tie::Floor)
    local_ = into_frame(apart.direction, tie_ == Tie::First ? first.body.heading : second.body.heading);
}

Axis::Tie Axis::tie_between_corners(const Separation& apart, const PhaseMotion& first, const PhaseMotion& second) {
  const Vec2 passing_mps = second.point(foremost_corner(second.body, -apart.direction)).velocity_mps -
                           first.point(foremost_corner(first.body, apart.direction)).velocity_mps;
  const double turning = cross(apart.direction, passing_mps) / std::max(apart.clearance_m, kEquallyNear_m);
  const double off_floor = std::abs(turning), off_first = std::abs(turning - first.turning_rad_s());
  const double off_second = std::abs(turning - second.turning_rad_s());
  if (first.rotates() && off_first < off_floor && off_first <= off_second) return Tie::First;
  return second.rotates() && off_second < off_floor ? Tie::Second : Tie::Floor;
}

Vec2 Axis::direction(const OrientedRectangle& first, const OrientedRectangle& second) const {
  if (tie_ == Tie::Floor) return local_;
  return rotated(local_, tie_ == Tie::First ? first.heading : second.heading);
}

GapBound::GapBound(const PhaseMotion& first, const PhaseMotion& second, const Axis& axis) {
  const Vec2 direction = axis.direction(first.body, second.body);
  if (axis.tie() == Axis::Tie::First) {
    add_corners_seen_from(first, second, direction);
  } else if (axis.tie() == Axis::Tie::Second) {
    add_corners_seen_from(second, first, -direction);
  } else {
    add_corners_apart(first, second, direction);
    exact_ = count_ == 1;
  }
}

void GapBound::add_corners_apart(const PhaseMotion& first, const PhaseMotion& second, const Vec2& direction) {
  const Reaches near(first, direction), far(second, -direction);
  const double apart = direction.dot(second.body.centre_m - first.body.centre_m);
  for (std::size_t i = 0; i < near.count; ++i) {
    const Reach& p = near.of[i];
    for (std::size_t j = 0; j < far.count; ++j) {
      const Reach& q = far.of[j];
      terms_[count_++] = {apart - p.value - q.value,
                          -(p.rate + q.rate),
                          -(p.bend + q.bend),
                          p.loss + q.loss,
                          0.0,
                          -(p.most + q.most),
                          0.0};
    }
  }
}

// Seen from the body that the axis turns with, that body rests, and a corner at r (from its centre) of the other
// has the derivatives that a turning frame gives it: r' - w Jr, r'' - 2w Jr' - a Jr - w^2 r, and a third one
// below r''' + 3w r'' + 3(a + w^2) r' + (3wa + w^3 + a') r in magnitude; J is left_of, w the frame's rate of turning, a
// the rate's own, and a' that of a.
void GapBound::add_corners_seen_from(const PhaseMotion& frame, const PhaseMotion& other, const Vec2& outward) {
  const PointMotion origin = frame.point(Vec2::Zero());
  const double w = frame.turning_rad_s(), a = frame.turning_rad_s2();
  const double top_w = frame.top_turning.rad_s, top_a = frame.top_turning.rad_s2;
  const double half_m = frame.half_extent_m(outward);
  const double second = top_a + top_w * top_w,
               third = 3.0 * top_w * top_a + top_w * top_w * top_w + frame.top_turning.rad_s3;
  for (const Vec2& arm : corner_arms(other.body)) {
    const PointMotion corner = other.point(arm);
    const Vec2 r = corner.position_m - origin.position_m, v = corner.velocity_mps - origin.velocity_mps;
    const double top_v = corner.top_mps + origin.top_mps, top_r2 = corner.top_mps2 + origin.top_mps2, length = r.norm();
    Term& term = terms_[count_++];
    term.value = outward.dot(r) - half_m;
    term.rate = outward.dot(v - w * left_of(r));
    term.bend = outward.dot(corner.acceleration_mps2 - origin.acceleration_mps2 - 2.0 * w * left_of(v) -
                            a * left_of(r) - w * w * r);
    term.loss =
        (corner.top_mps3 + origin.top_mps3 + 3.0 * top_w * top_r2 + 3.0 * second * top_v + third * length) / 3.0;
    term.loss_growth = third * top_v / 3.0;
    term.least = -(top_r2 + 2.0 * top_w * top_v + second * length);
    term.least_growth = -second * top_v;
  }
  if (other.rotates()) tighten_by_pivots(frame, other);
}

// If both bodies rotate, the frame shows two motions. The pivot of the other body turns about the pivot of the frame. A
// corner turns about the pivot of the other body, at the difference of both rates. Bodies that follow each other round
// the same bend do not move at all. On Bezier curves, a pivot is a point of the body that stands still at this instant:
// from then on it drifts as the curvature changes.
void GapBound::tighten_by_pivots(const PhaseMotion& frame, const PhaseMotion& other) {
  if (!has_pivot(frame) || !has_pivot(other)) return;
  const PointMotion pivot = other.point(other.pivot_arm()), origin = frame.point(frame.pivot_arm());
  const double between_m = (pivot.position_m - origin.position_m).norm();
  const double w = other.turning_rad_s() - frame.turning_rad_s(), a = other.turning_rad_s2() - frame.turning_rad_s2();
  const double lasts_s = std::min(frame.lasts_s, other.lasts_s),
               top_turn3 = frame.top_turning.rad_s3 + other.top_turning.rad_s3;
  // The largest turning of the bodies against each other, up to the end of the phase.
  const double top_a = std::abs(a) + top_turn3 * lasts_s;
  const double top_w =
      top_turn3 > 0.0 ? std::abs(w) + top_a * lasts_s : std::max(std::abs(w), std::abs(w + a * lasts_s));
  const TurningBound pivots(frame.top_turning.rad_s, frame.top_turning.rad_s2, frame.top_turning.rad_s3);
  const TurningBound corners(top_w, top_a, top_turn3);
  // Pivots stand still unless a curvature changes. Then their drift costs the bound something.
  double drift2 = 0.0, drift3 = 0.0;
  if (frame.varies || other.varies) {
    const double v = pivot.top_mps + origin.top_mps, v2 = pivot.top_mps2 + origin.top_mps2;
    const double turning = frame.top_turning.rad_s, second = frame.top_turning.rad_s2 + turning * turning;
    drift2 = v2 + 2.0 * turning * v + pivots.second * v * lasts_s;
    drift3 = pivot.top_mps3 + origin.top_mps3 + 3.0 * turning * v2 + 3.0 * second * v + pivots.third * v * lasts_s;
  }
  // Each corner has a bound already. The one through the pivots replaces a part of it only where it is tighter.
  const std::array<Vec2, 4> arms = corner_arms(other.body);
  for (std::size_t i = 0; i < 4; ++i) {
    const double radius_m = (other.body.centre_m + arms[i] - pivot.position_m).norm();
    const double loss = (between_m * pivots.third + radius_m * corners.third + drift3) / 3.0;
    const double least = -(between_m * pivots.second + radius_m * corners.second + drift2);
    Term& term = terms_[i];
    if (loss < term.loss) term.loss = loss, term.loss_growth = 0.0;
    if (least > term.least) term.least = least, term.least_growth = 0.0;
  }
}

double GapBound::now_m() const {
  double least = terms_[0].value;
  for (std::size_t i = 1; i < count_; ++i) least = std::min(least, terms_[i].value);
  return least;
}

GapBound::Trend GapBound::trend() const {
  const double least = now_m();
  Trend trend{least, kNotMet, 0.0};
  for (std::size_t i = 0; i < count_; ++i) {
    const Term& term = terms_[i];
    if (term.value - least < kEquallyNear_m && term.rate < trend.rate_mps) trend = {term.value, term.rate, term.bend};
  }
  return trend;
}

double GapBound::safe_within_s(double level_m, double horizon_s) const {
  double safe_s = horizon_s;
  for (std::size_t i = 0; i < count_; ++i) {
    const Term& term = terms_[i];
    const double value = term.value - level_m, bend = exact_ ? term.bend : term.bend_within(horizon_s);
    if (value <= 0.0) return 0.0;
    // Most pairs of corners cannot meet in time: no root needed.
    if (value + safe_s * (std::min(term.rate, 0.0) + 0.5 * safe_s * std::min(bend, 0.0)) > 0.0) continue;
    safe_s = std::min(safe_s, first_root(value, term.rate, bend));
  }
  return safe_s;
}

double GapBound::safe_s(double level_m, double horizon_s) const {
  const double safe_s = safe_within_s(level_m, horizon_s);
  if (exact_ || safe_s <= 0.0 || safe_s >= horizon_s) return safe_s;
  // The nearer the horizon, the better the bound: does it hold a little longer than it has proved to?
  return std::max(safe_s, safe_within_s(level_m, std::min(3.0 * safe_s, 0.5 * (safe_s + horizon_s))));
}

}  // namespace fleetproof
