#include "core/clearance/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/tolerances.hpp"
#include "core/geometry/rotation.hpp"

namespace fleetproof {
namespace {

// Below it a cover is not worth another division: two of them are within kSweepSlack_m.
constexpr double kFinest_m = kSweepSlack_m / 4.0;

}  // namespace

void Sweep::add_turn(const Pose& pose, double turn_rad) {
  stretches_.push_back({Stretch::Kind::Turn, pose, nullptr, false, std::min(0.0, turn_rad), std::max(0.0, turn_rad)});
}

void Sweep::add_drive(const Curve& curve) {
  for (const CurvePart& part : curve.parts()) {
    const auto kind = part.is_straight() ? Stretch::Kind::Straight : Stretch::Kind::Bend;
    stretches_.push_back({kind, part.pose_at(0.0), &part, curve.is_tail_first(), 0.0, part.length_m()});
  }
}

// The body in the middle of the stretch. No point of it moves farther to either end than the reference point and the
// turn about it take it. On a straight line the rectangle is as long as the way, and nothing is beyond it.
Sweep::Cover Sweep::cover(const Stretch& stretch) const {
  const double half = 0.5 * (stretch.to - stretch.from), middle = stretch.from + half;
  Pose pose = stretch.start;
  double slack_m = 0.0;
  switch (stretch.kind) {
    case Stretch::Kind::Straight:
      pose.position_m += middle * pose.heading;
      break;
    case Stretch::Kind::Turn:
      pose.heading = rotated(pose.heading, unit_vector(middle));
      slack_m = half * footprint_.reach_m();
      break;
    case Stretch::Kind::Bend:
      pose = stretch.part->pose_at(middle);
      slack_m = half * (1.0 + stretch.part->most().per_m * footprint_.reach_m());
      break;
  }
  if (stretch.tail_first) pose.heading = -pose.heading;
  OrientedRectangle rectangle = placed(footprint_, pose);
  if (stretch.kind == Stretch::Kind::Straight) rectangle.half_length_m += half;
  return {rectangle, slack_m};
}

// Divides the coarser stretch of a pair until the pair is plainly apart, or plainly not.
bool may_come_closer(const Sweep& a, const Sweep& b, double distance_m) {
  const double limit_m = distance_m - kBuiltToTheLimit_m;
  std::vector<std::pair<Sweep::Stretch, Sweep::Stretch>> open;
  for (const Sweep::Stretch& one : a.stretches_) {
    for (const Sweep::Stretch& other : b.stretches_) open.emplace_back(one, other);
  }
  while (!open.empty()) {
    auto [one, other] = open.back();
    open.pop_back();
    const Sweep::Cover first = a.cover(one), second = b.cover(other);
    const double reach_m = first.slack_m + second.slack_m;
    const double centres_m = (first.rectangle.centre_m - second.rectangle.centre_m).norm();
    const auto radius_m = [](const OrientedRectangle& r) { return Vec2(r.half_length_m, r.half_width_m).norm(); };
    if (centres_m - radius_m(first.rectangle) - radius_m(second.rectangle) - reach_m >= limit_m) continue;
    const double apart_m = clearance_m(first.rectangle, second.rectangle);
    if (apart_m < limit_m) return true;
    if (apart_m - reach_m >= limit_m) continue;
    if (std::max(first.slack_m, second.slack_m) <= kFinest_m) return true;
    Sweep::Stretch& coarse = first.slack_m >= second.slack_m ? one : other;
    const double middle = 0.5 * (coarse.from + coarse.to), end = std::exchange(coarse.to, middle);
    open.emplace_back(one, other);
    coarse.from = middle, coarse.to = end;
    open.emplace_back(one, other);
  }
  return false;
}

}  // namespace fleetproof
