#include "core/clearance/phase_motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/geometry/rotation.hpp"

namespace fleetproof {
namespace {

// Nanoseconds since the piece began.
using Elapsed = std::int64_t;

// A phase of the profile on one part of the curve.
struct TimeSpan {
  Elapsed change;  // where it ends, in the sense walked
  std::size_t phase = 0, part = 0;
};

// Ends of phases and joints are rounded to whole nanoseconds. The error of place is less than the motion of a body in
// one nanosecond. The error does not grow: every phase starts from the exact pose, with the speed that the phase itself
// has at the instant. The profile may still give the speed of the neighbouring phase there. This speed is wrong by a
// nanometre per second, which would move a body by nanometres in a few seconds.
TimeSpan phase_from(const MotionProfile& profile, Elapsed now, TimeSense sense) {
  const auto& ends = profile.phase_ends();
  std::size_t phase = 0;
  if (sense == TimeSense::Forward) {
    while (phase < 2 && ends[phase].count() <= now) ++phase;
    return {ends[phase].count(), phase};
  }
  while (phase < 2 && ends[phase].count() < now) ++phase;
  return {phase == 0 ? 0 : ends[phase - 1].count(), phase};
}

TimeSpan span_from(const Piece& piece, Elapsed now, TimeSense sense) {
  TimeSpan span = phase_from(piece.profile, now, sense);
  if (piece.manner != Manner::Drive || piece.curve->parts().size() < 2) return span;
  const auto ends = piece.curve->ends_m();
  const double way = piece.way_begin_m + piece.profile.position(to_seconds(Duration{now}));
  const auto joint = [&](std::size_t i) { return seconds(piece.profile.time_at(ends[i] - piece.way_begin_m)).count(); };
  span.part = piece.curve->part_at(way);
  if (sense == TimeSense::Forward) {
    while (span.part + 1 < ends.size() && joint(span.part) <= now) ++span.part;
    if (span.part + 1 < ends.size()) span.change = std::min(span.change, joint(span.part));
  } else {
    while (span.part > 0 && joint(span.part - 1) >= now) --span.part;
    if (span.part > 0) span.change = std::max(span.change, joint(span.part - 1));
  }
  return span;
}

// The bounds that follow from how the curve bends. With the lever l, the arm r, the speed v, its change a, the
// curvature k and the turning w = k v, a point has the acceleration a l + w v Jl + k' v^2 Jr, where J is left_of, and
// the jerk (3 a w + k' v^3) Jl - v w^2 l + (3 a k' v + k'' v^3) Jr - 2 k' v^2 w r.
void bound_turning(PhaseMotion& motion, const MostBending& most) {
  const double v = motion.top_speed, a = std::abs(motion.acceleration), way_m = v * motion.lasts_s;
  motion.varies = most.per_m2 > 0.0 || most.per_m3 > 0.0;
  const double k2 = std::min(most.per_m2, std::abs(motion.bending) + most.per_m3 * way_m),
               k = motion.varies ? std::min(most.per_m, std::abs(motion.curvature) + k2 * way_m)
                                 : std::abs(motion.curvature);
  const double w = k * v, pull = w * v, changing = k2 * v * v;
  motion.top_turning.rad_s = w;
  motion.top_turning.rad_s2 = k * a + changing;
  motion.top_acceleration = std::sqrt(a * a + pull * pull);
  if (!motion.varies) {
    motion.top_jerk = w * std::sqrt(9.0 * (a * a) + pull * pull);
    return;
  }
  const double along = 3.0 * a * w + changing * v, across = pull * w;
  motion.top_turning.rad_s3 = 3.0 * k2 * v * a + most.per_m3 * v * v * v;
  motion.top_jerk = std::sqrt(along * along + across * across);
  motion.per_arm.lever = k2 * way_m;
  motion.per_arm.mps2 = changing;
  motion.per_arm.mps3 = motion.top_turning.rad_s3 + 2.0 * changing * w;
}

}  // namespace

PointMotion PhaseMotion::point(const Vec2& arm) const {
  const Vec2 from_reference = arm + centre_ahead_m * body.heading;
  const Vec2 lever = turns_on_spot ? left_of(from_reference) : Vec2(body.heading + curvature * left_of(from_reference));
  PointMotion motion;
  motion.position_m = body.centre_m + arm;
  motion.velocity_mps = speed * lever;
  motion.acceleration_mps2 = acceleration * lever + curvature * speed * speed * left_of(lever);
  if (varies) motion.acceleration_mps2 += bending * speed * speed * left_of(from_reference);
  const double arm_m = varies ? from_reference.norm() : 0.0, length = lever.norm() + per_arm.lever * arm_m;
  motion.top_mps = length * top_speed;
  motion.top_mps2 = length * top_acceleration + per_arm.mps2 * arm_m;
  motion.top_mps3 = length * top_jerk + per_arm.mps3 * arm_m;
  return motion;
}

double PhaseMotion::half_extent_m(const Vec2& direction) const {
  return body.half_length_m * std::abs(direction.dot(body.heading)) +
         body.half_width_m * std::abs(cross(body.heading, direction));
}

PhaseMotion motion_from(const Piece& piece, const OrientedRectangle& body, SimTime t, SimTime limit, TimeSense sense) {
  PhaseMotion motion;
  motion.body = body;
  motion.centre_ahead_m = piece.footprint.centre_ahead_m;
  // A body at rest is the default: it keeps its place up to the limit.
  motion.change = limit;
  motion.lasts_s = to_seconds(Duration{std::abs((limit - t).count())});
  const bool forward = sense == TimeSense::Forward;
  const Elapsed now = (t - piece.begin).count(), last = (limit - piece.begin).count();
  const Elapsed arrival = piece.profile.duration().count();
  // At rest, also before it has begun to move (seen backwards) and after it has arrived.
  if (piece.manner == Manner::Rest || (forward ? now >= arrival : now <= 0)) return motion;
  // The body moves now. Or, seen backwards, it stands after its arrival: then it rests until then. What follows holds
  // for one phase of the profile and one part of the curve.
  const bool has_arrived = now > arrival;
  const TimeSpan span = has_arrived ? TimeSpan{arrival} : span_from(piece, now, sense);
  const Elapsed change = forward ? std::min(span.change, last) : std::max(span.change, last);
  motion.change = piece.begin + Duration{change};
  motion.lasts_s = to_seconds(Duration{std::abs(change - now)});
  if (has_arrived) return motion;
  const double sign = piece.moves_against_heading() ? -1.0 : 1.0;
  motion.speed = piece.profile.speed_in_phase(span.phase, to_seconds(Duration{now})) * (forward ? sign : -sign);
  motion.acceleration = piece.profile.acceleration_in_phase(span.phase) * sign;
  const double later = piece.profile.speed_in_phase(span.phase, to_seconds(Duration{change}));
  motion.top_speed = std::max(std::abs(motion.speed), std::abs(later));
  motion.top_acceleration = std::abs(motion.acceleration);
  // The motion along the way is known. What is left is how the body turns: on the spot, or with a bend.
  motion.turns_on_spot = piece.manner == Manner::Turn;
  if (motion.turns_on_spot) {
    motion.curvature = 1.0;
    bound_turning(motion, {1.0, 0.0, 0.0});
  } else if (const CurvePart& part = piece.curve->parts()[span.part]; !part.is_straight()) {
    const auto [per_m, per_m2] = piece.curve->bending_in(span.part, piece.way_at(t));
    motion.curvature = sign * per_m;
    motion.bending = per_m2;
    bound_turning(motion, part.most());
  }
  return motion;
}

}  // namespace fleetproof
