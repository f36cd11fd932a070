#include "core/phase_motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/geometry/rotation.hpp"

namespace fleetproof {
namespace {

// Nanoseconds since the piece began.
using Elapsed = std::int64_t;
constexpr Elapsed kNever = std::int64_t{1} << 62;

struct Stretch {
  Elapsed change;  // -kNever or kNever: none
  std::size_t arc = 0;
};

// Ends of phases and joints are rounded to whole nanoseconds. What that misplaces is less than what a body does in one nanosecond, and not
// carried along: every phase starts from the exact pose.
Elapsed next_phase(const MotionProfile& profile, Elapsed now, TimeSense sense) {
  Elapsed before = 0;
  for (const double end_s : profile.phase_ends_s()) {
    const Elapsed end = seconds(end_s).count();
    if (sense == TimeSense::Forward ? end > now : end >= now) return sense == TimeSense::Forward ? end : before;
    before = end;
  }
  return sense == TimeSense::Forward ? kNever : before;
}

Stretch next_stretch(const Piece& piece, Elapsed now, double way, TimeSense sense) {
  Stretch stretch{next_phase(piece.profile, now, sense)};
  if (piece.manner != Manner::Drive || piece.curve->arcs().size() < 2) return stretch;
  const auto ends = piece.curve->ends_m();
  const auto joint = [&](std::size_t i) { return seconds(piece.profile.time_at(ends[i])).count(); };
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

PhaseMotion motion_from(const Piece& piece, SimTime t, SimTime limit, TimeSense sense) {
  PhaseMotion motion;
  motion.change = limit;
  if (piece.manner == Manner::Rest) {
    motion.body = placed(piece.footprint, piece.start);
    return motion;
  }
  motion.body = piece.body_at(t);
  const bool forward = sense == TimeSense::Forward;
  const Elapsed now = (t - piece.begin).count(), last = (limit - piece.begin).count();
  const double now_s = to_seconds(Duration{now});
  const Elapsed profile_end = piece.profile.duration().count();
  // Before it has begun to move, or after it has arrived.
  if (forward ? now >= profile_end : now <= 0) return motion;
  const Stretch stretch = next_stretch(piece, now, piece.profile.position(now_s), sense);
  const Elapsed change = forward ? std::min(stretch.change, last) : std::max(stretch.change, last);
  motion.change = piece.begin + Duration{change};
  const double change_s = to_seconds(Duration{change});
  const bool arrived = !forward && now > profile_end;
  const double sign = piece.manner == Manner::Turn && piece.turn_rad < 0.0 ? -1.0 : 1.0;
  motion.speed = arrived ? 0.0 : piece.profile.speed(now_s) * (forward ? sign : -sign);
  motion.acceleration = arrived ? 0.0 : piece.profile.acceleration(0.5 * (now_s + change_s)) * sign;
  motion.top_speed = std::max(std::abs(motion.speed), piece.profile.speed(change_s));
  motion.turns_on_spot = piece.manner == Manner::Turn;
  motion.curvature = motion.turns_on_spot ? 1.0 : piece.curve->arcs()[stretch.arc].curvature_per_m;
  return motion;
}

Reach reach(const PhaseMotion& motion, const Vec2& direction) {
  const OrientedRectangle& body = motion.body;
  const Vec2 along = body.half_length_m * body.heading, aside = body.half_width_m * left_of(body.heading);
  const double middle = direction.dot(body.centre_m);
  Reach result;
  if (!motion.rotates()) {
    const double lead = direction.dot(body.heading), bend = motion.acceleration * lead;
    result.of[0] = {middle + std::abs(direction.dot(along)) + std::abs(direction.dot(aside)), motion.speed * lead, bend, 0.0, bend};
    result.count = 1;
    return result;
  }
  // A lever turns at the rate curvature * speed. So its corner's second derivative is acceleration * lever + pull * left_of(lever), never above
  // `most` levers; and the third is never above `jerk` levers, which keeps the second near its present value for a while.
  const double pull = motion.curvature * motion.speed * motion.speed, top_pull = motion.curvature * motion.top_speed * motion.top_speed;
  const double squared = motion.acceleration * motion.acceleration;
  const double most = std::sqrt(squared + top_pull * top_pull);
  const double jerk = std::abs(motion.curvature) * motion.top_speed * std::sqrt(9.0 * squared + top_pull * top_pull);
  for (const Vec2& arm : {Vec2(along + aside), Vec2(aside - along), Vec2(-along - aside), Vec2(along - aside)}) {
    const Vec2 lever = motion.lever(arm);
    const double length = lever.norm(), lead = direction.dot(lever), cross_lead = direction.dot(left_of(lever));
    const double bend = motion.acceleration * lead + pull * cross_lead;
    // A third of the growth: a constant third derivative contributes x^3 / 6.
    result.of[result.count++] = {middle + direction.dot(arm), motion.speed * lead, bend, length * jerk / 3.0, length * most};
  }
  return result;
}

}  // namespace fleetproof
