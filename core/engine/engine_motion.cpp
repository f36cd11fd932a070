// Actions of AGVs: how a call becomes turn, drive and stay, how each ends or is cut short, and what two bodies that
// touch do to each other.
#include <algorithm>

#include "core/base/error.hpp"
#include "core/base/random.hpp"
#include "core/engine/engine.hpp"
#include "core/geometry/rotation.hpp"

namespace fleetproof {
namespace {

// Headings that differ by less are the same: well below what any turn activity would resolve, well above rounding of a
// curve's end.
constexpr double kAligned_rad = 1e-7;

ActivityKind stay_of(fp_call call) {
  switch (call) {
    case FP_CALL_PICK:
      return ActivityKind::Pick;
    case FP_CALL_DROP:
      return ActivityKind::Drop;
    case FP_CALL_CHARGE:
      return ActivityKind::Charge;
    default:
      return ActivityKind::Park;
  }
}

fp_action doing(ActivityKind kind) {
  switch (kind) {
    case ActivityKind::Drive:
    case ActivityKind::Settle:
      return FP_DRIVING;
    case ActivityKind::Turn:
      return FP_TURNING;
    case ActivityKind::Pick:
      return FP_PICKING;
    case ActivityKind::Drop:
      return FP_DROPPING;
    case ActivityKind::Charge:
      return FP_CHARGING_NOW;
    default:
      return FP_PARKED;
  }
}

bool on_its_way(const Agv& agv) {
  return agv.acting && agv.plan.lane != nullptr && agv.plan.call == FP_CALL_MOVE && !agv.next;
}

}  // namespace

double Engine::motion_draw(MotionTopic topic, const Agv& agv, std::uint32_t number) const {
  return unit_interval(word64(philox(motion_key_, {number, 0, static_cast<std::uint32_t>(topic), agv.id.value}), 0));
}

bool Engine::aligned(const Lane& arriving, const Lane& leaving) const {
  const Vec2 in = arriving.curve.pose_at(arriving.curve.length_m()).heading, out = leaving.curve.pose_at(0.0).heading;
  return std::abs(angle_between(in, out)) <= kAligned_rad;
}

std::int32_t Engine::act(Agv& agv, fp_call call, std::uint32_t segment) {
  const bool here = segment == FP_HERE && call != FP_CALL_MOVE;
  if (!here && segment >= scenario_.map->segment_count()) return FP_INVALID;
  const bool pending =
      std::ranges::find(agv.pending_calls, PendingCall::Kind::Action, &PendingCall::kind) != agv.pending_calls.end();
  bool possible = !agv.out_of_order && !pending;
  if (agv.committed) {
    possible =
        possible && !here && on_its_way(agv) && scenario_.map->lane(SegmentId{segment}, agv.plan.lane->to) != nullptr;
  } else {
    possible = possible && (here || scenario_.map->lane(SegmentId{segment}, agv.station) != nullptr);
  }
  if (!possible) {
    ++outcome_.counters.refused_calls;
    trace(agv.id, TraceKind::CallRefused, static_cast<std::uint64_t>(call), segment);
    return FP_REFUSED;
  }
  const bool first = !agv.committed;
  agv.committed = true;
  if (!takes_effect_now(agv)) {
    take_effect_later(
        agv, {.kind = PendingCall::Kind::Action, .what = static_cast<std::uint32_t>(call), .segment = segment});
  } else if (first) {
    begin_action(agv, call, segment);
  } else {
    take_next(agv, call, segment);
  }
  return FP_OK;
}

void Engine::begin_action(Agv& agv, fp_call call, std::uint32_t segment) {
  if (agv.out_of_order) return action_done(agv, FP_REFUSED);
  if (agv.acting) return take_next(agv, call, segment);  // the action before this one is not over yet
  if (agv.activity) end_activity(agv, false);            // charging goes on until the next action
  const Lane* lane = segment == FP_HERE ? nullptr : scenario_.map->lane(SegmentId{segment}, agv.station);
  begin_plan(agv, call, lane, 0.0);
}

void Engine::begin_plan(Agv& agv, fp_call call, const Lane* lane, double entry_mps) {
  agv.acting = agv.committed = true;
  agv.plan = {call, lane, lane != nullptr, false, call != FP_CALL_MOVE, 0.0};
  continue_plan(agv, entry_mps);
}

void Engine::continue_plan(Agv& agv, double entry_mps) {
  agv.plan_waits = !agv.halts.empty() && entry_mps == 0.0;
  if (agv.plan_waits) return;  // the end of the halt continues it
  if (agv.plan.drive_due) return turn_or_drive(agv, entry_mps);
  if (agv.plan.settle_due) return begin_settling(agv);
  if (agv.plan.stay_due) {
    agv.plan.stay_due = false;
    return begin_stay(agv);
  }
  agv.doing = FP_IDLE;
  finish_action(agv, 0.0);
}

// The action is over; the one released before that begins at once, rolling if the AGV has not stopped.
void Engine::finish_action(Agv& agv, double speed_mps) {
  const auto next = agv.next;
  agv.next.reset();
  agv.acting = agv.committed = false;
  if (next) begin_plan(agv, next->call, next->lane, speed_mps);
  action_done(agv, FP_OK);
}

void Engine::turn_or_drive(Agv& agv, double entry_mps) {
  const VehicleType& type = type_of(agv);
  const Pose pose = world_.pose_of(agv.id, now_);
  const double turn_rad =
      entry_mps > 0.0 ? 0.0 : angle_between(pose.heading, agv.plan.lane->curve.pose_at(agv.plan.way_m).heading);
  if (std::abs(turn_rad) <= kAligned_rad) return begin_drive(agv, entry_mps);
  Piece piece = standing_piece(agv, pose);
  piece.manner = Manner::Turn;
  piece.turn_rad = turn_rad;
  piece.profile = MotionProfile(std::abs(turn_rad), type.turn);
  piece.end = piece.begin + piece.profile.duration();
  ++outcome_.counters.turns;
  set_piece(agv, piece);
  progressed(agv);
  begin_activity(agv, {ActivityKind::Turn, agv.id, piece.begin, piece.end, SpatialEvolution{piece}}, agv.station.value);
  predict_touches(agv.id);
}

// A piece of the AGV's body as it is now, for the caller to set in motion.
Piece Engine::standing_piece(const Agv& agv, const Pose& pose) const {
  return rest_piece(agv.id, type_of(agv).footprint_with(is_loaded(agv)), pose, now_);
}

void Engine::begin_settling(Agv& agv) {
  agv.plan.settle_due = false;
  const Duration lasts = seconds(type_of(agv).settle_s * motion_draw(MotionTopic::Settling, agv, agv.drives));
  begin_activity(agv, {ActivityKind::Settle, agv.id, now_, now_ + lasts, Standing{}}, agv.station.value);
}

void Engine::begin_stay(Agv& agv) {
  const VehicleType& type = type_of(agv);
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
    const bool at_storage = scenario_.map->station(agv.station).purposes.has(Purpose::Storage);
    const double spread_s = at_storage ? type.storage_spread_s : type.other_spread_s;
    activity.end = now_ + seconds((pick ? type.pick_s : type.drop_s) +
                                  spread_s * motion_draw(MotionTopic::Transfer, agv, ++agv.stays));
    activity.evolution = evolution;
    subject = evolution.load.value;
    progressed(agv);
  } else if (kind == ActivityKind::Charge) {
    settle_battery(agv);
    activity.end = now_ + seconds(std::max(0.0, (1.0 - agv.battery) / type.charge_per_s));
    activity.evolution = BatteryEvolution{type.charge_per_s};
  }
  begin_activity(agv, std::move(activity), subject);
  if (kind == ActivityKind::Charge) finish_action(agv, 0.0);  // connected: done as far as the agent is concerned
}

void Engine::begin_activity(Agv& agv, Activity activity, std::uint64_t subject) {
  agv.doing = doing(activity.kind);
  trace(agv.id, TraceKind::ActivityBegins, static_cast<std::uint64_t>(activity.kind), subject);
  queue_.push(activity.end, agv.id, Event::Kind::ActivityEnds, 0, ++agv.activity_stamp);
  agv.activity = std::move(activity);
  predict_empty_battery(agv);
}

void Engine::activity_ends(Agv& agv) {
  const ActivityKind kind = agv.activity->kind;
  if (kind == ActivityKind::Drive) return leg_ends(agv);
  end_activity(agv, true);
  if (kind == ActivityKind::Charge) {
    agv.doing = agv.committed ? agv.doing : FP_IDLE;
    return;
  }
  if (kind == ActivityKind::Park) {
    agv.doing = FP_PARKED;
    return finish_action(agv, 0.0);
  }
  continue_plan(agv, 0.0);
}

void Engine::end_activity(Agv& agv, bool as_planned) {
  settle_battery(agv);
  const Activity activity = *agv.activity;
  agv.activity.reset();
  ++agv.activity_stamp;
  if (activity.kind != ActivityKind::Park && activity.kind != ActivityKind::Charge) progressed(agv);
  if (const auto* spatial = std::get_if<SpatialEvolution>(&activity.evolution)) {
    const Piece& piece = spatial->piece;
    const Pose pose = as_planned && activity.kind == ActivityKind::Turn
                          ? Pose{piece.start.position_m, agv.plan.lane->curve.pose_at(agv.plan.way_m).heading}
                          // exactly the lane's heading
                          : piece.pose_at(now_);
    stand(agv, pose);
  } else if (const auto* containment = std::get_if<ContainmentEvolution>(&activity.evolution)) {
    if (as_planned) transfer(agv, *containment);
  }
  trace(agv.id, TraceKind::ActivityEnds, static_cast<std::uint64_t>(activity.kind), as_planned ? 1 : 0);
  predict_empty_battery(agv);
}

void Engine::set_piece(Agv& agv, const Piece& piece) {
  const Duration late = seconds(scenario_.agvs[agv.id.index()].sensing.position_late_s);
  if (late > Duration::zero()) {
    agv.past.push_back(world_.body(agv.id).piece);
    agv.past.back().end = now_;
    while (agv.past.front().end < now_ - late) agv.past.pop_front();
  }
  radio_.piece_begins(piece);
  world_.continue_with(agv.id, piece);
}

void Engine::stand(Agv& agv, const Pose& pose) {
  set_piece(agv, standing_piece(agv, pose));
  predict_touches(agv.id);
}

void Engine::transfer(Agv& agv, const ContainmentEvolution& evolution) {
  if (!evolution.load.valid()) return;
  const Load& load = world_.load(evolution.load);
  if (evolution.to.kind == Holder::Kind::Station && load.holder != Holder{Holder::Kind::Agv, agv.id.value})
    return;  // it fell off meanwhile
  move_load(evolution.load, evolution.to);
  if (type_of(agv).loaded != LoadEffect{}) stand(agv, world_.pose_of(agv.id, now_));  // the body has grown or shrunk
  if (evolution.to.kind == Holder::Kind::Agv) {
    load_taken_up(agv, load.transport);
  } else if (evolution.to == Holder{Holder::Kind::Station, load.destination.value}) {
    ++outcome_.counters.transports_done;
    trace(agv.id, TraceKind::TransportDone, load.transport.value);
  }
}

void Engine::predict_touches(EntityId id) {
  const std::size_t before = touches_.size();
  world_.predict_touches(id, touches_);
  for (std::size_t i = before; i < touches_.size(); ++i)
    queue_.push(touches_[i].at, touches_[i].a, Event::Kind::Contact, i);
}

bool Engine::is_current(const TouchPrediction& touch) const {
  const Body &a = world_.body(touch.a), &b = world_.body(touch.b);
  return a.on_floor && b.on_floor && a.piece.number == touch.piece_a && b.piece.number == touch.piece_b;
}

void Engine::bodies_touch(EntityId, std::uint64_t prediction) {
  const TouchPrediction touch = touches_[prediction];
  if (!is_current(touch) || world_.have_touched(touch.a, touch.b)) return;
  world_.remember_touch(touch.a, touch.b);
  ++outcome_.counters.contacts;
  trace(touch.a, TraceKind::Contact, touch.b.value);
  if (!scenario_.contact_stops) return;
  stop_for_good(touch.a);
  stop_for_good(touch.b);
}

void Engine::stop_for_good(EntityId id) {
  if (!world_.body(id).is_agv || agvs_[id.index()].out_of_order) return;
  Agv& agv = agvs_[id.index()];
  agv.out_of_order = true;
  // An action that has yet to take effect answers for itself when it finds the AGV out of order.
  const bool pending =
      std::ranges::find(agv.pending_calls, PendingCall::Kind::Action, &PendingCall::kind) != agv.pending_calls.end();
  const int under_way = (agv.acting ? 1 : 0) + (agv.next ? 1 : 0);
  const bool driving = agv.activity && agv.activity->kind == ActivityKind::Drive;
  agv.stopped_on = agv.acting && (driving || (agv.plan.drive_due && agv.plan.way_m > 0.0)) ? agv.plan.lane : nullptr;
  if (agv.activity) end_activity(agv, false);
  agv.plan = {};
  agv.next.reset();
  agv.doing = FP_OUT_OF_ORDER;
  for (int i = 0; i < under_way; ++i) action_done(agv, FP_REFUSED);
  agv.committed = pending;
  call_operator(agv, Assist::Contact, 0);
}

void Engine::action_done(Agv& agv, fp_result result) {
  if (result != FP_OK) agv.acting = agv.committed = false;
  fp_event done{};
  done.kind = FP_EVENT_ACTION_DONE;
  done.result = result;
  tell(agv, done);
}

}  // namespace fleetproof
