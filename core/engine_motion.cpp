// Activities of AGVs: how a call becomes turn, drive and stay, how each ends or is cut short, and what two bodies that touch do to each other.
#include <algorithm>

#include "core/engine.hpp"
#include "core/error.hpp"
#include "core/geometry/rotation.hpp"

namespace fleetproof {
namespace {

// Headings that differ by less are the same: well below what any turn activity would resolve, well above rounding of a curve's end.
constexpr double kAligned_rad = 1e-7;

ActivityKind stay_of(fp_call call) {
  switch (call) {
    case FP_CALL_PICK: return ActivityKind::Pick;
    case FP_CALL_DROP: return ActivityKind::Drop;
    case FP_CALL_CHARGE: return ActivityKind::Charge;
    default: return ActivityKind::Park;
  }
}

fp_action doing(ActivityKind kind) {
  switch (kind) {
    case ActivityKind::Drive: return FP_DRIVING;
    case ActivityKind::Turn: return FP_TURNING;
    case ActivityKind::Pick: return FP_PICKING;
    case ActivityKind::Drop: return FP_DROPPING;
    case ActivityKind::Charge: return FP_CHARGING_NOW;
    default: return FP_PARKED;
  }
}

}  // namespace

std::int32_t Engine::act(Agv& agv, fp_call call, std::uint32_t segment) {
  const bool here = segment == FP_HERE && call != FP_CALL_MOVE;
  if (!here && segment >= scenario_.map->segment_count()) return FP_INVALID;
  const bool possible = !agv.committed && !agv.out_of_order && (here || scenario_.map->lane(SegmentId{segment}, agv.station) != nullptr);
  if (!possible) {
    ++outcome_.counters.refused_calls;
    trace(agv.id, TraceKind::CallRefused, static_cast<std::uint64_t>(call), segment);
    return FP_REFUSED;
  }
  agv.committed = true;
  if (takes_effect_now(agv)) {
    begin_action(agv, call, segment);
  } else {
    take_effect_later(agv, {.kind = PendingCall::Kind::Action, .what = static_cast<std::uint32_t>(call), .segment = segment});
  }
  return FP_OK;
}

void Engine::begin_action(Agv& agv, fp_call call, std::uint32_t segment) {
  if (agv.out_of_order) return action_done(agv, FP_REFUSED);
  if (agv.activity) end_activity(agv, false);  // charging goes on until the next action
  const Lane* lane = segment == FP_HERE ? nullptr : scenario_.map->lane(SegmentId{segment}, agv.station);
  agv.plan = {call, lane, lane != nullptr, call != FP_CALL_MOVE};
  continue_plan(agv);
}

void Engine::continue_plan(Agv& agv) {
  if (agv.plan.drive_due) {
    const VehicleType& type = scenario_.type_of(scenario_.agvs[agv.id.index()]);
    const Pose pose = world_.pose_of(agv.id, now_);
    Piece piece;
    piece.entity = agv.id;
    piece.footprint = type.footprint;
    piece.begin = now_;
    piece.start = pose;
    const double turn_rad = angle_between(pose.heading, agv.plan.lane->curve.pose_at(0.0).heading);
    if (std::abs(turn_rad) > kAligned_rad) {
      piece.manner = Manner::Turn;
      piece.turn_rad = turn_rad;
      piece.profile = MotionProfile(std::abs(turn_rad), type.turn);
      return begin_motion(agv, ActivityKind::Turn, piece);
    }
    agv.plan.drive_due = false;
    piece.manner = Manner::Drive;
    piece.segment = agv.plan.lane->segment;
    piece.curve = &agv.plan.lane->curve;
    piece.profile = MotionProfile(piece.curve->length_m(), type.drive);
    return begin_motion(agv, ActivityKind::Drive, piece);
  }
  if (agv.plan.stay_due) {
    agv.plan.stay_due = false;
    return begin_stay(agv);
  }
  agv.doing = FP_IDLE;
  action_done(agv, FP_OK);
}

void Engine::begin_motion(Agv& agv, ActivityKind kind, Piece piece) {
  piece.end = piece.begin + piece.profile.duration();
  ++(kind == ActivityKind::Drive ? outcome_.counters.drives : outcome_.counters.turns);
  world_.continue_with(agv.id, piece);
  last_progress_ = now_;
  const std::uint64_t subject = kind == ActivityKind::Drive ? piece.segment.value : agv.station.value;
  begin_activity(agv, {kind, agv.id, piece.begin, piece.end, SpatialEvolution{piece}}, subject);
  predict_touches(agv.id);
}

void Engine::begin_stay(Agv& agv) {
  const VehicleType& type = scenario_.type_of(scenario_.agvs[agv.id.index()]);
  const ActivityKind kind = stay_of(agv.plan.call);
  Activity activity{kind, agv.id, now_, now_, Standing{}};
  std::uint64_t subject = agv.station.value;
  if (kind == ActivityKind::Pick || kind == ActivityKind::Drop) {
    const bool pick = kind == ActivityKind::Pick;
    ContainmentEvolution evolution;
    const LoadId carried = world_.carried_load(agv.id);
    if (pick && !carried.valid()) evolution.load = world_.waiting_load(agv.id, agv.station);
    if (!pick) evolution.load = carried;
    evolution.to = pick ? Holder{Holder::Kind::Agv, agv.id.value} : Holder{Holder::Kind::Station, agv.station.value};
    activity.end = now_ + seconds(pick ? type.pick_s : type.drop_s);
    activity.evolution = evolution;
    subject = evolution.load.value;
  } else if (kind == ActivityKind::Charge) {
    activity.end = now_ + seconds(std::max(0.0, (1.0 - agv.battery) / type.charge_per_s));
    activity.evolution = BatteryEvolution{type.charge_per_s};
  }
  if (kind == ActivityKind::Pick || kind == ActivityKind::Drop) last_progress_ = now_;
  begin_activity(agv, std::move(activity), subject);
  if (kind == ActivityKind::Charge) action_done(agv, FP_OK);  // connected: done as far as the agent is concerned
}

void Engine::begin_activity(Agv& agv, Activity activity, std::uint64_t subject) {
  agv.doing = doing(activity.kind);
  trace(agv.id, TraceKind::ActivityBegins, static_cast<std::uint64_t>(activity.kind), subject);
  queue_.push(activity.end, agv.id, Event::Kind::ActivityEnds, 0, ++agv.activity_stamp);
  agv.activity = std::move(activity);
}

void Engine::activity_ends(Agv& agv) {
  const bool charging = agv.activity->kind == ActivityKind::Charge;
  const bool parking = agv.activity->kind == ActivityKind::Park;
  end_activity(agv, true);
  if (charging) {
    agv.doing = agv.committed ? agv.doing : FP_IDLE;
    return;
  }
  if (parking) {
    agv.doing = FP_PARKED;
    return action_done(agv, FP_OK);
  }
  continue_plan(agv);
}

void Engine::end_activity(Agv& agv, bool as_planned) {
  const Activity activity = *agv.activity;
  agv.activity.reset();
  ++agv.activity_stamp;
  if (activity.kind != ActivityKind::Park && activity.kind != ActivityKind::Charge) last_progress_ = now_;
  if (const auto* spatial = std::get_if<SpatialEvolution>(&activity.evolution)) {
    const Piece& piece = spatial->piece;
    if (activity.kind == ActivityKind::Drive) {
      const double driven_m = piece.profile.position(to_seconds(now_ - piece.begin));
      agv.battery = std::max(0.0, agv.battery - driven_m * scenario_.type_of(scenario_.agvs[agv.id.index()]).battery_per_m);
      outcome_.counters.distance_um += static_cast<std::uint64_t>(driven_m * 1e6);
      if (as_planned) agv.station = agv.plan.lane->to;
    }
    const Pose pose = as_planned && activity.kind == ActivityKind::Turn
                          ? Pose{piece.start.position_m, agv.plan.lane->curve.pose_at(0.0).heading}  // exactly the lane's heading
                          : piece.pose_at(now_);
    world_.continue_with(agv.id, rest_piece(agv.id, piece.footprint, pose, now_));
    predict_touches(agv.id);
  } else if (const auto* containment = std::get_if<ContainmentEvolution>(&activity.evolution)) {
    if (as_planned) transfer(agv, *containment);
  } else if (const auto* charge = std::get_if<BatteryEvolution>(&activity.evolution)) {
    agv.battery = std::min(1.0, agv.battery + charge->per_s * to_seconds(now_ - activity.begin));
  }
  trace(agv.id, TraceKind::ActivityEnds, static_cast<std::uint64_t>(activity.kind), as_planned ? 1 : 0);
}

void Engine::transfer(Agv& agv, const ContainmentEvolution& evolution) {
  if (!evolution.load.valid()) return;
  Load& load = world_.load(evolution.load);
  load.holder = evolution.to;
  trace_load(agv, evolution.load);
  if (evolution.to == Holder{Holder::Kind::Station, load.destination.value}) {
    ++outcome_.counters.transports_done;
    trace(agv.id, TraceKind::TransportDone, load.transport.value);
  }
}

void Engine::trace_load(const Agv& agv, LoadId id) {
  const Holder& holder = world_.load(id).holder;
  trace(agv.id, TraceKind::LoadMoves, id.value, static_cast<std::uint64_t>(holder.kind) << 32 | holder.index);
}

double Engine::battery_of(const Agv& agv) const {
  if (!agv.activity) return agv.battery;
  const double elapsed_s = to_seconds(now_ - agv.activity->begin);
  if (const auto* charge = std::get_if<BatteryEvolution>(&agv.activity->evolution)) return std::min(1.0, agv.battery + charge->per_s * elapsed_s);
  if (agv.activity->kind != ActivityKind::Drive) return agv.battery;
  const auto& piece = std::get<SpatialEvolution>(agv.activity->evolution).piece;
  return std::max(0.0, agv.battery - piece.profile.position(elapsed_s) * scenario_.type_of(scenario_.agvs[agv.id.index()]).battery_per_m);
}

void Engine::predict_touches(EntityId id) {
  const std::size_t before = touches_.size();
  world_.predict_touches(id, touches_);
  for (std::size_t i = before; i < touches_.size(); ++i) queue_.push(touches_[i].at, touches_[i].a, Event::Kind::Contact, i);
}

void Engine::bodies_touch(EntityId, std::uint64_t prediction) {
  const TouchPrediction touch = touches_[prediction];
  const bool current = world_.body(touch.a).piece.number == touch.piece_a && world_.body(touch.b).piece.number == touch.piece_b;
  if (!current || world_.have_touched(touch.a, touch.b)) return;
  world_.remember_touch(touch.a, touch.b);
  ++outcome_.counters.contacts;
  trace(touch.a, TraceKind::Contact, touch.b.value);
  if (!scenario_.contact_stops) return;
  stop_for_good(touch.a);
  stop_for_good(touch.b);
}

void Engine::stop_for_good(EntityId id) {
  if (!world_.body(id).is_agv || world_.body(id).out_of_order) return;
  Agv& agv = agvs_[id.index()];
  world_.put_out_of_order(id);
  agv.out_of_order = true;
  // An action that has yet to take effect answers for itself when it finds the AGV out of order.
  const bool action_pending = std::ranges::find(agv.pending_calls, PendingCall::Kind::Action, &PendingCall::kind) != agv.pending_calls.end();
  const bool acting = agv.committed && !action_pending;
  if (agv.activity) end_activity(agv, false);
  agv.plan = {};
  agv.doing = FP_OUT_OF_ORDER;
  if (acting) action_done(agv, FP_REFUSED);
}

void Engine::action_done(Agv& agv, fp_result result) {
  agv.committed = false;
  fp_event done{};
  done.kind = FP_EVENT_ACTION_DONE;
  done.result = result;
  tell(agv, done);
}

}  // namespace fleetproof
