#include "core/gap_bound.hpp"

#include <cmath>
#include <limits>

#include "core/geometry/rotation.hpp"

namespace fleetproof {
namespace {

constexpr double kNotMet = std::numeric_limits<double>::infinity();

// Least positive root of value + rate * x + bend * x^2 / 2, for a positive value.
double first_root(double value, double rate, double bend) {
  const double square = rate * rate - 2.0 * bend * value;
  if (rate < 0.0) return square < 0.0 ? kNotMet : 2.0 * value / (std::sqrt(square) - rate);
  return bend < 0.0 ? (rate + std::sqrt(square)) / -bend : kNotMet;
}

// The corners that can be the foremost along a direction while the phase lasts, from the reference point.
struct Arms {
  std::array<Vec2, 4> arm_m;
  std::size_t count = 4;
};

Arms all_corners(const OrientedRectangle& body) {
  const Vec2 along = body.half_length_m * body.heading, aside = body.half_width_m * left_of(body.heading);
  return {{along + aside, aside - along, -along - aside, along - aside}};
}

Arms foremost_corners(const PhaseMotion& motion, const Vec2& direction) {
  Arms arms = all_corners(motion.body);
  if (motion.rotates()) return arms;
  for (std::size_t i = 1; i < 4; ++i) {
    if (direction.dot(arms.arm_m[i]) > direction.dot(arms.arm_m[0])) arms.arm_m[0] = arms.arm_m[i];
  }
  arms.count = 1;
  return arms;
}

bool is_side(const Vec2& direction, const OrientedRectangle& body) {
  constexpr double kAligned = 1e-9;
  return std::min(std::abs(direction.dot(body.heading)), std::abs(cross(body.heading, direction))) < kAligned;
}

Vec2 into_frame(const Vec2& direction, const Vec2& heading) { return {direction.dot(heading), cross(heading, direction)}; }

}  // namespace

Axis::Axis(const Vec2& direction, const PhaseMotion& first, const PhaseMotion& second) : local_(direction) {
  const bool first_side = is_side(direction, first.body), second_side = is_side(direction, second.body);
  if (first_side && first.rotates() && !(second_side && !second.rotates())) {
    tie_ = Tie::First;
    local_ = into_frame(direction, first.body.heading);
  } else if (second_side && second.rotates() && !(first_side && !first.rotates())) {
    tie_ = Tie::Second;
    local_ = into_frame(direction, second.body.heading);
  }
}

Vec2 Axis::direction(const OrientedRectangle& first, const OrientedRectangle& second) const {
  if (tie_ == Tie::Floor) return local_;
  return rotated(local_, tie_ == Tie::First ? first.heading : second.heading);
}

GapBound::GapBound(const PhaseMotion& first, const PhaseMotion& second, const Axis& axis) {
  const Vec2 direction = axis.direction(first.body, second.body);
  if (axis.tie() == Axis::Tie::First) {
    add_corners_from_side(first, second, direction);
  } else if (axis.tie() == Axis::Tie::Second) {
    add_corners_from_side(second, first, -direction);
  } else {
    add_corners_apart(first, second, direction);
    exact_ = count_ == 1;
  }
}

void GapBound::add_corners_apart(const PhaseMotion& first, const PhaseMotion& second, const Vec2& direction) {
  const Arms near = foremost_corners(first, direction), far = foremost_corners(second, -direction);
  std::array<PointMotion, 4> theirs;
  for (std::size_t j = 0; j < far.count; ++j) theirs[j] = second.point(far.arm_m[j]);
  for (std::size_t i = 0; i < near.count; ++i) {
    const PointMotion p = first.point(near.arm_m[i]);
    for (std::size_t j = 0; j < far.count; ++j) {
      const PointMotion& q = theirs[j];
      Term& term = terms_[count_++];
      term.value = direction.dot(q.position_m - p.position_m);
      term.rate = direction.dot(q.velocity_mps - p.velocity_mps);
      term.bend = direction.dot(q.acceleration_mps2 - p.acceleration_mps2);
      term.loss = (p.top_mps3 + q.top_mps3) / 3.0;
      term.least = -(p.top_mps2 + q.top_mps2);
    }
  }
}

// Seen from the body whose side it is, the side rests, and a corner at r (from the reference point) of the other has the derivatives that a turning
// frame gives it: r' - w Jr, r'' - 2w Jr' - a Jr - w^2 r, and a third one below r''' + 3w r'' + 3(a + w^2) r' + (3wa + w^3) r in magnitude; J is
// left_of, w the frame's rate of turning and a the rate's own.
void GapBound::add_corners_from_side(const PhaseMotion& sided, const PhaseMotion& other, const Vec2& outward) {
  const PointMotion origin = sided.point(Vec2::Zero());
  const double w = sided.turning_rad_s(), a = sided.curvature * sided.acceleration;
  const double top_w = std::abs(sided.curvature) * sided.top_speed, top_a = std::abs(a);
  const double half_m = sided.half_extent_m(outward);
  const double second = top_a + top_w * top_w, third = 3.0 * top_w * top_a + top_w * top_w * top_w;
  for (const Vec2& arm : all_corners(other.body).arm_m) {
    const PointMotion corner = other.point(arm);
    const Vec2 r = corner.position_m - origin.position_m, v = corner.velocity_mps - origin.velocity_mps;
    const double top_v = corner.top_mps + origin.top_mps, top_r2 = corner.top_mps2 + origin.top_mps2, length = r.norm();
    Term& term = terms_[count_++];
    term.value = outward.dot(r) - half_m;
    term.rate = outward.dot(v - w * left_of(r));
    term.bend = outward.dot(corner.acceleration_mps2 - origin.acceleration_mps2 - 2.0 * w * left_of(v) - a * left_of(r) - w * w * r);
    term.loss = (corner.top_mps3 + origin.top_mps3 + 3.0 * top_w * top_r2 + 3.0 * second * top_v + third * length) / 3.0;
    term.loss_growth = third * top_v / 3.0;
    term.least = -(top_r2 + 2.0 * top_w * top_v + second * length);
    term.least_growth = -second * top_v;
  }
}

double GapBound::now_m() const {
  double least = terms_[0].value;
  for (std::size_t i = 1; i < count_; ++i) least = std::min(least, terms_[i].value);
  return least;
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
  constexpr int kLooks = 4;
  double safe_s = safe_within_s(level_m, horizon_s), open_s = horizon_s;
  if (exact_) return safe_s;
  // The nearer the horizon, the better the bound: look whether it holds a little longer than it has proved to.
  for (int i = 0; i < kLooks && safe_s > 0.0 && safe_s < 0.9 * open_s; ++i) {
    const double h_s = std::min(3.0 * safe_s, 0.5 * (safe_s + open_s)), proved_s = safe_within_s(level_m, h_s);
    if (proved_s < h_s) open_s = h_s;
    safe_s = std::max(safe_s, proved_s);
  }
  return safe_s;
}

}  // namespace fleetproof
