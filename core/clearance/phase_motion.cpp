#include "core/clearance/phase_motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/geometry/rotation.hpp"

namespace fleetproof {
namespace {

// Nanoseconds since the piece began.
using Elapsed = std::int64_t;

// A phase of the profile on one arc of the curve.
struct Stretch {
  Elapsed change;  // where it ends, in the sense walked
  std::size_t phase = 0, arc = 0;
};

// Ends of phases and joints are rounded to whole nanoseconds. The error of place is less than the motion of a body in
// one nanosecond. The error does not grow: every phase starts from the exact pose, with the speed that the phase itself
// has at the instant. The profile may still give the speed of the neighbouring phase there. This speed is wrong by a
// nanometre per second, which would move a body by nanometres in a few seconds.
Stretch phase_from(const MotionProfile& profile, Elapsed now, TimeSense sense) {
  const auto& ends = profile.phase_ends();
  std::size_t phase = 0;
  if (sense == TimeSense::Forward) {
    while (phase < 2 && ends[phase].count() <= now) ++phase;
    return {ends[phase].count(), phase};
  }
  while (phase < 2 && ends[phase].count() < now) ++phase;
  return {phase == 0 ? 0 : ends[phase - 1].count(), phase};
}

Stretch stretch_from(const Piece& piece, Elapsed now, TimeSense sense) {
  Stretch stretch = phase_from(piece.profile, now, sense);
  if (piece.manner != Manner::Drive || piece.curve->arcs().size() < 2) return stretch;
  const auto ends = piece.curve->ends_m();
  const double way = piece.way_begin_m + piece.profile.position(to_seconds(Duration{now}));
  const auto joint = [&](std::size_t i) { return seconds(piece.profile.time_at(ends[i] - piece.way_begin_m)).count(); };
  stretch.arc = static_cast<std::size_t>(&piece.curve->arc_at(way) - piece.curve->arcs().data());
  if (sense == TimeSense::Forward) {
    while (stretch.arc + 1 < ends.size() && joint(stretch.arc) <= now) ++stretch.arc;
    if (stretch.arc + 1 < ends.size()) stretch.change = std::min(stretch.change, joint(stretch.arc));
  } else {
    while (stretch.arc > 0 && joint(stretch.arc - 1) >= now) --stretch.arc;
    if (stretch.arc > 0) stretch.change = std::max(stretch.change, joint(stretch.arc - 1));
  }
  return stretch;
}

}  // namespace

PointMotion PhaseMotion::point(const Vec2& arm) const {
  const Vec2 lever = turns_on_spot ? left_of(arm) : Vec2(body.heading + curvature * left_of(arm));
  const double length = lever.norm();
  PointMotion motion;
  motion.position_m = body.centre_m + arm;
  motion.velocity_mps = speed * lever;
  motion.acceleration_mps2 = acceleration * lever + curvature * speed * speed * left_of(lever);
  motion.top_mps = length * top_speed;
  motion.top_mps2 = length * top_acceleration;
  motion.top_mps3 = length * top_jerk;
  return motion;
}

double PhaseMotion::half_extent_m(const Vec2& direction) const {
  return body.half_length_m * std::abs(direction.dot(body.heading)) +
         body.half_width_m * std::abs(cross(body.heading, direction));
}

PhaseMotion motion_from(const Piece& piece, const OrientedRectangle& body, SimTime t, SimTime limit, TimeSense sense) {
  PhaseMotion motion;
  motion.body = body;
  motion.change = limit;
  motion.lasts_s = to_seconds(Duration{std::abs((limit - t).count())});
  const bool forward = sense == TimeSense::Forward;
  const Elapsed now = (t - piece.begin).count(), last = (limit - piece.begin).count();
  const Elapsed arrival = piece.profile.duration().count();
  // At rest, also before it has begun to move (seen backwards) and after it has arrived.
  if (piece.manner == Manner::Rest || (forward ? now >= arrival : now <= 0)) return motion;
  const bool has_arrived = now > arrival;
  const Stretch stretch = has_arrived ? Stretch{arrival} : stretch_from(piece, now, sense);
  const Elapsed change = forward ? std::min(stretch.change, last) : std::max(stretch.change, last);
  motion.change = piece.begin + Duration{change};
  motion.lasts_s = to_seconds(Duration{std::abs(change - now)});
  if (has_arrived) return motion;
  const double sign = piece.manner == Manner::Turn && piece.turn_rad < 0.0 ? -1.0 : 1.0;
  motion.speed = piece.profile.speed_in_phase(stretch.phase, to_seconds(Duration{now})) * (forward ? sign : -sign);
  motion.acceleration = piece.profile.acceleration_in_phase(stretch.phase) * sign;
  motion.turns_on_spot = piece.manner == Manner::Turn;
  motion.curvature = motion.turns_on_spot ? 1.0 : piece.curve->arcs()[stretch.arc].curvature_per_m;
  const double later = piece.profile.speed_in_phase(stretch.phase, to_seconds(Duration{change}));
  motion.top_speed = std::max(std::abs(motion.speed), std::abs(later));
  motion.top_acceleration = std::abs(motion.acceleration);
  if (motion.curvature == 0.0) return motion;
  // A lever turns at the rate curvature * speed, which pulls square to it.
  const double squared = motion.acceleration * motion.acceleration,
               top_turning = std::abs(motion.curvature) * motion.top_speed;
  const double top_pull = top_turning * motion.top_speed;
  motion.top_acceleration = std::sqrt(squared + top_pull * top_pull);
  motion.top_jerk = top_turning * std::sqrt(9.0 * squared + top_pull * top_pull);
  return motion;
}

}  // namespace fleetproof
