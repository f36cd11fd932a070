// Drives: legs of one speed limit each, rolling through a station, braking in mid-segment and going on from there.
#include <algorithm>

#include "core/base/error.hpp"
#include "core/engine/engine.hpp"

namespace fleetproof {

void Engine::begin_drive(Agv& agv, double entry_mps) {
  const VehicleType& type = type_of(agv);
  agv.plan.drive_due = false;
  agv.battery_way_m = agv.plan.way_m;
  MotionLimits& limits = agv.drive.limits;
  limits = type.drive_with(is_loaded(agv));
  ++agv.drives;
  if (type.speed_deviation > 0.0) {
    const double factor = 1.0 + type.speed_deviation * (2.0 * motion_draw(MotionTopic::Speed, agv, agv.drives) - 1.0);
    limits.speed_mps *= factor;
    limits.acceleration_mps2 *= factor;  // not the brakes: that a stop is possible must stay true
  }
  ++outcome_.counters.drives;
  progressed(agv);
  plan_rest_of_drive(agv, agv.plan.way_m, entry_mps);
  Activity activity{ActivityKind::Drive, agv.id, now_, now_, SpatialEvolution{first_leg_piece(agv)}};
  activity.end = std::get<SpatialEvolution>(activity.evolution).piece.end;
  set_piece(agv, std::get<SpatialEvolution>(activity.evolution).piece);
  begin_activity(agv, std::move(activity), agv.plan.lane->segment.value);
  predict_touches(agv.id);
  if (scenario_.scanner.on) scanner_wakes(agv);
}

void Engine::plan_rest_of_drive(Agv& agv, double from_m, double speed_mps) {
  const Curve& curve = agv.plan.lane->curve;
  from_m = std::min(from_m, curve.length_m());  // legs that begin in the middle round
  agv.drive.leg = 0;
  if (!agv.halts.empty()) {
    plan_stop(curve, agv.drive.limits, from_m, speed_mps, agv.drive.legs);
  } else {
    plan_legs(curve, agv.drive.limits, type_of(agv).lateral_mps2, from_m, {speed_mps, exit_speed_mps(agv)},
              agv.drive.legs);
  }
}

// How fast the AGV may pass the station at the end of its lane: standing, unless the next action has been released and
// goes straight on.
double Engine::exit_speed_mps(const Agv& agv) const {
  if (!agv.next || agv.next->lane == nullptr || !aligned(*agv.plan.lane, *agv.next->lane)) return 0.0;
  MotionLimits limits = agv.drive.limits;
  limits.speed_mps = std::min(limits.speed_mps, type_of(agv).drive_with(is_loaded(agv)).speed_mps);
  return highest_entry_mps(agv.next->lane->curve, limits, type_of(agv).lateral_mps2);
}

Piece Engine::first_leg_piece(const Agv& agv) const {
  const Leg& leg = agv.drive.legs[agv.drive.leg];
  Piece piece = standing_piece(agv, world_.pose_of(agv.id, now_));
  piece.manner = Manner::Drive;
  piece.segment = agv.plan.lane->segment;
  piece.curve = &agv.plan.lane->curve;
  piece.way_begin_m = leg.begin_m;
  MotionLimits limits = agv.drive.limits;
  limits.speed_mps = leg.limit_mps;
  piece.profile = MotionProfile(leg.end_m - leg.begin_m, limits, leg.speeds);
  piece.end = piece.begin + piece.profile.duration();
  return piece;
}

// The drive under way goes on with its leg, in a piece of its own.
void Engine::begin_leg(Agv& agv) {
  settle_battery(agv);
  const Piece piece = first_leg_piece(agv);
  agv.activity->evolution = SpatialEvolution{piece};
  agv.activity->end = piece.end;
  set_piece(agv, piece);
  queue_.push(piece.end, agv.id, Event::Kind::ActivityEnds, 0, ++agv.activity_stamp);
  predict_touches(agv.id);
  predict_empty_battery(agv);
}

// Something has changed that decides how fast the AGV drives: it goes on from where it is, as fast as it is.
void Engine::replan_drive(Agv& agv) {
  const Piece piece = std::get<SpatialEvolution>(agv.activity->evolution).piece;
  plan_rest_of_drive(agv, piece.way_at(now_), piece.speed_at(now_));
  begin_leg(agv);
}

void Engine::leg_ends(Agv& agv) {
  const Leg done = agv.drive.legs[agv.drive.leg];
  if (++agv.drive.leg < agv.drive.legs.size()) return begin_leg(agv);
  const bool arrived = done.end_m >= agv.plan.lane->curve.length_m();
  const double speed_mps = done.speeds.exit_mps;
  if (!arrived) return drive_halts(agv, done.end_m);
  agv.station = agv.plan.lane->to;
  if (speed_mps > 0.0) return roll_on(agv, speed_mps);
  end_activity(agv, true);
  agv.plan.settle_due = type_of(agv).settle_s > 0.0;
  continue_plan(agv, 0.0);
}

// Past the station without a stop. The piece of the next drive follows the one that ends now.
void Engine::roll_on(Agv& agv, double speed_mps) {
  ensure(agv.next.has_value(), "who rolls through a station knows where to go");
  settle_battery(agv);
  agv.activity.reset();
  ++agv.activity_stamp;
  ++outcome_.counters.rolls;
  trace(agv.id, TraceKind::ActivityEnds, static_cast<std::uint64_t>(ActivityKind::Drive), 1);
  finish_action(agv, speed_mps);
}

void Engine::drive_halts(Agv& agv, double way_m) {
  agv.plan.way_m = way_m;
  agv.plan.drive_due = true;
  end_activity(agv, false);
  continue_plan(agv, 0.0);  // the halt may be over by now
}

void Engine::take_next(Agv& agv, fp_call call, std::uint32_t segment) {
  const Lane* lane = scenario_.map->lane(SegmentId{segment}, agv.plan.lane->to);
  ensure(lane != nullptr, "the next action begins where this one ends");
  agv.next = NextAction{call, lane};
  if (!agv.activity || agv.activity->kind != ActivityKind::Drive || !agv.halts.empty() || exit_speed_mps(agv) == 0.0)
    return;
  const Piece& piece = std::get<SpatialEvolution>(agv.activity->evolution).piece;
  const bool last_leg = agv.drive.leg + 1 == agv.drive.legs.size();
  const bool braking = last_leg && to_seconds(now_ - piece.begin) >= piece.profile.phase_ends_s()[1];
  if (!braking) replan_drive(agv);
}

}  // namespace fleetproof
