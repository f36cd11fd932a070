#include "core/engine/actions.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/tolerances.hpp"
#include "core/engine/drives.hpp"
#include "core/geometry/rotation.hpp"
#include "core/outcome/note_records.hpp"
#include "core/scenario/lane_rules.hpp"

namespace fleetproof {
namespace {

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

fp_action action_during(ActivityKind kind) {
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
    case ActivityKind::Dock:
    case ActivityKind::Charge:
      return FP_CHARGING_NOW;
    default:
      return FP_PARKED;
  }
}

// The lane that a call means; null: there is none. Without FP_BACKWARD it is the way forward, or backward if there is
// no other.
const Lane* called_lane(const LogicalMap& map, std::uint32_t segment, StationId from) {
  if ((segment & FP_BACKWARD) != 0) return map.backward_lane(SegmentId{segment & ~FP_BACKWARD}, from);
  return map.lane(SegmentId{segment}, from);
}

// The load that the agent has named may be gone by now, if its transport is open or was withdrawn.
LoadId load_to_pick(const World& world, AgvId agv, StationId station, LoadId named) {
  if (!named.valid()) return world.waiting_load(agv, station);
  return world.is_waiting(named, agv, station) ? named : LoadId{};
}

}  // namespace

Actions::Actions(RunContext& run, const Ports& ports) : run_(run), ports_(ports), agv_states_(run.agvs.size()) {}

// ---- calls

bool Actions::accept(AgvId agv, fp_call call, std::uint32_t segment, LoadId load) {
  const SegmentId called{segment == FP_HERE ? segment : segment & ~FP_BACKWARD};
  if (!is_possible(agv, call, segment, load)) {
    ++run_.counters.refused_calls;
    run_.trace(agv, traced::CallRefused{static_cast<std::uint32_t>(call), called});
    return false;
  }
  if (run_.hears_notes()) run_.note(agv, traced::CallAccepted{static_cast<std::uint32_t>(call), called});
  agv_states_[agv.index()].committed = agv_states_[agv.index()].accepted = true;
  return true;
}

// A second action may follow a move that is under way, if it leaves the station where that move ends.
bool Actions::is_possible(AgvId agv, fp_call call, std::uint32_t segment, LoadId load) const {
  const AgvState& agv_state = agv_states_[agv.index()];
  const AgvStatus& status = run_.status(agv);
  if (status.out_of_order || agv_state.accepted) return false;
  const LogicalMap& map = *run_.scenario.map;
  const LaneRules rules{map, run_.type_of(agv).name, run_.is_loaded(agv)};
  const bool here = segment == FP_HERE && call != FP_CALL_MOVE;
  const bool on_its_way =
      agv_state.acting && agv_state.plan.lane != nullptr && agv_state.plan.call == FP_CALL_MOVE && !agv_state.next;
  if (agv_state.committed && (here || !on_its_way)) return false;
  const StationId begins_at = agv_state.committed ? agv_state.plan.lane->to : status.station;
  const Vec2 heading = agv_state.committed ? agv_state.plan.lane->end_heading() : run_.pose_now(agv).heading;
  const Lane* lane = here ? nullptr : called_lane(map, segment, begins_at);
  if (!here && (lane == nullptr || !rules.may_drive(*lane, heading))) return false;
  const StationId ends_at = here ? begins_at : lane->to;
  if (call != FP_CALL_MOVE && !rules.may_stay(ends_at, here ? heading : lane->end_heading())) return false;
  return !load.valid() || (!run_.is_loaded(agv) && run_.world.is_waiting(load, agv, ends_at));
}

void Actions::begin(AgvId agv, fp_call call, std::uint32_t segment, LoadId load) {
  AgvState& agv_state = agv_states_[agv.index()];
  AgvStatus& status = run_.status(agv);
  agv_state.accepted = false;
  if (status.out_of_order) {
    agv_state.acting = agv_state.committed = false;
    return tell_done(agv, FP_REFUSED);
  }
  if (agv_state.acting) return take_next(agv, call, segment, load);  // the action before this one is not over yet
  if (status.activity) ports_.activities.end(agv, false);            // charging goes on until the next action
  const Lane* lane = segment == FP_HERE ? nullptr : called_lane(*run_.scenario.map, segment, status.station);
  begin_plan(agv, {call, lane, load}, 0.0);
}

void Actions::withdraw_accepted(AgvId agv) {
  AgvState& agv_state = agv_states_[agv.index()];
  if (!agv_state.accepted) return;
  agv_state.accepted = false;
  agv_state.committed = agv_state.acting;
}

void Actions::take_next(AgvId agv, fp_call call, std::uint32_t segment, LoadId load) {
  AgvState& agv_state = agv_states_[agv.index()];
  const Lane* lane = called_lane(*run_.scenario.map, segment, agv_state.plan.lane->to);
  ensure(lane != nullptr, "the next action begins where this one ends");
  agv_state.next = NextAction{call, lane, load};
  if (run_.status(agv).is_driving()) ports_.drives.release_next(agv, *lane);
}

void Actions::tell_done(AgvId agv, fp_result result) {
  fp_event done{};
  done.kind = FP_EVENT_ACTION_DONE;
  done.result = result;
  ports_.agents.tell(agv, done);
}

// ---- from one activity to the next

void Actions::begin_plan(AgvId agv, const NextAction& action, double entry_mps) {
  AgvState& agv_state = agv_states_[agv.index()];
  agv_state.acting = agv_state.committed = true;
  const auto& [call, lane, load] = action;
  const bool docks = call == FP_CALL_CHARGE && run_.type_of(agv).dock_s > 0.0;
  agv_state.plan = {call, lane, lane != nullptr, false, docks, call != FP_CALL_MOVE, 0.0, false, load};
  continue_plan(agv, entry_mps);
}

void Actions::continue_plan(AgvId agv, double entry_mps) {
  AgvState& agv_state = agv_states_[agv.index()];
  const AgvStatus& status = run_.status(agv);
  agv_state.waits = entry_mps == 0.0 && (agv_state.plan.drive_due ? !status.halts.empty() : status.is_held());
  if (agv_state.waits) return;  // the end of the halt continues it
  if (agv_state.plan.drive_due) return turn_or_drive(agv, entry_mps);
  if (agv_state.plan.settle_due) return begin_settling(agv);
  if (agv_state.plan.dock_due) return begin_docking(agv);
  if (agv_state.plan.stay_due) return begin_stay(agv);
  agv_state.doing = FP_IDLE;
  finish(agv, 0.0);
}

// The action is over. The one queued behind it begins at once, rolling if the AGV has not stopped.
void Actions::finish(AgvId agv, double speed_mps) {
  AgvState& agv_state = agv_states_[agv.index()];
  const auto next = agv_state.next;
  agv_state.next.reset();
  agv_state.acting = agv_state.committed = false;
  if (next) begin_plan(agv, *next, speed_mps);
  tell_done(agv, FP_OK);
}

void Actions::turn_or_drive(AgvId agv, double entry_mps) {
  AgvState& agv_state = agv_states_[agv.index()];
  Plan& plan = agv_state.plan;
  const Pose pose = run_.pose_now(agv);
  const double turn_rad =
      entry_mps > 0.0 ? 0.0 : angle_between(pose.heading, plan.lane->curve.pose_at(plan.way_m).heading);
  if (std::abs(turn_rad) <= kAligned_rad) {
    plan.drive_due = false;
    agv_state.doing = action_during(ActivityKind::Drive);
    return ports_.drives.begin(agv, *plan.lane, plan.way_m, entry_mps, agv_state.next ? agv_state.next->lane : nullptr);
  }
  Piece piece = run_.standing_piece(agv, pose);
  piece.manner = Manner::Turn;
  piece.turn_rad = turn_rad;
  piece.profile = MotionProfile(std::abs(turn_rad), run_.type_of(agv).turn.as_motion());
  piece.end = piece.begin + piece.profile.duration();
  ++run_.counters.turns;
  run_.progressed(agv);
  agv_state.doing = action_during(ActivityKind::Turn);
  ports_.activities.begin_moving(agv, ActivityKind::Turn, piece, run_.status(agv).station.value);
}

void Actions::begin_activity(AgvId agv, const Activity& activity, std::uint64_t subject) {
  agv_states_[agv.index()].doing = action_during(activity.kind);
  ports_.activities.begin(agv, activity, subject);
}

void Actions::begin_settling(AgvId agv) {
  agv_states_[agv.index()].plan.settle_due = false;
  const double draw = run_.motion_draw(MotionTopic::Settling, agv, ports_.drives.begun(agv));
  const Duration lasts = seconds(run_.type_of(agv).settle_s * draw);
  begin_activity(agv, {ActivityKind::Settle, agv, run_.now, run_.now + lasts, Standing{}},
                 run_.status(agv).station.value);
}

void Actions::begin_docking(AgvId agv) {
  agv_states_[agv.index()].plan.dock_due = false;
  const SimTime connected = run_.now + seconds(run_.type_of(agv).dock_s);
  begin_activity(agv, {ActivityKind::Dock, agv, run_.now, connected, Standing{}}, run_.status(agv).station.value);
}

void Actions::begin_stay(AgvId agv) {
  agv_states_[agv.index()].plan.stay_due = false;
  const StationId station = run_.status(agv).station;
  const ActivityKind kind = stay_of(agv_states_[agv.index()].plan.call);
  if (kind == ActivityKind::Pick || kind == ActivityKind::Drop) return begin_transfer(agv, kind);
  if (kind == ActivityKind::Park)
    return begin_activity(agv, {kind, agv, run_.now, run_.now, Standing{}}, station.value);
  const double per_s = run_.type_of(agv).charge_per_s;
  ports_.battery.settle(agv);
  const SimTime full = run_.now + seconds(std::max(0.0, (1.0 - ports_.battery.level(agv)) / per_s));
  begin_activity(agv, {kind, agv, run_.now, full, BatteryEvolution{per_s}}, station.value);
  finish(agv, 0.0);  // connected: for the agent, the action is done
}

void Actions::begin_transfer(AgvId agv, ActivityKind kind) {
  const VehicleType& type = run_.type_of(agv);
  const StationId station = run_.status(agv).station;
  const bool pick = kind == ActivityKind::Pick;
  ContainmentEvolution evolution;
  const LoadId carried = run_.world.carried_load(agv);
  if (pick && !carried.valid())
    evolution.load = load_to_pick(run_.world, agv, station, agv_states_[agv.index()].plan.load);
  if (!pick) evolution.load = carried;
  evolution.to = pick ? Holder{Holder::Kind::Agv, agv.value} : Holder{Holder::Kind::Station, station.value};
  const bool at_storage = run_.scenario.map->station(station).purposes.has(Purpose::Storage);
  const double spread_s = at_storage ? type.storage_spread_s : type.other_spread_s;
  const double draw = run_.motion_draw(MotionTopic::Transfer, agv, ++agv_states_[agv.index()].transfers);
  const SimTime end = run_.now + seconds((pick ? type.pick_s : type.drop_s) + spread_s * draw);
  run_.progressed(agv);
  begin_activity(agv, {kind, agv, run_.now, end, evolution}, evolution.load.value);
}

void Actions::activity_ends(AgvId agv) {
  AgvState& agv_state = agv_states_[agv.index()];
  const ActivityKind kind = run_.status(agv).activity->kind;
  switch (kind) {
    case ActivityKind::Drive:
      return leg_ends(agv);
    case ActivityKind::Turn:
      if (std::exchange(agv_state.plan.turn_ends_early, false)) {
        ports_.activities.end(agv, false);
      } else {
        ports_.activities.end_turn_at(agv, agv_state.plan.lane->curve.pose_at(agv_state.plan.way_m).heading);
      }
      return continue_plan(agv, 0.0);
    case ActivityKind::Charge:
      ports_.activities.end(agv, true);
      if (!agv_state.committed) agv_state.doing = FP_IDLE;
      return;
    case ActivityKind::Park:
      ports_.activities.end(agv, true);
      agv_state.doing = FP_PARKED;
      return finish(agv, 0.0);
    default:
      ports_.activities.end(agv, true);
      return continue_plan(agv, 0.0);
  }
}

void Actions::leg_ends(AgvId agv) {
  Plan& plan = agv_states_[agv.index()].plan;
  const LegEnd leg = ports_.drives.leg_ends(agv);
  if (leg.kind == LegEnd::Kind::NextLegBegins) return;
  if (leg.kind == LegEnd::Kind::Halted) {
    plan.way_m = leg.way_m;
    plan.drive_due = true;
    ports_.activities.end(agv, false);
    return continue_plan(agv, 0.0);  // the halt may be over by now
  }
  run_.status(agv).station = plan.lane->to;
  if (leg.speed_mps > 0.0) {
    ensure(agv_states_[agv.index()].next.has_value(), "an AGV that rolls through a station knows where to go");
    ports_.activities.end_rolling(agv);
    ++run_.counters.rolls;
    return finish(agv, leg.speed_mps);
  }
  ports_.activities.end(agv, true);
  plan.settle_due = run_.type_of(agv).settle_s > 0.0;
  continue_plan(agv, 0.0);
}

// ---- what cuts an action short

void Actions::brake(AgvId agv) {
  const AgvStatus& status = run_.status(agv);
  const ActivityKind kind = status.activity->kind;
  if (kind == ActivityKind::Drive) return ports_.drives.replan(agv);
  if (!status.is_held()) return kind == ActivityKind::Turn ? brake_turn(agv) : void();  // the agent holds motion only
  switch (kind) {
    case ActivityKind::Pick:
    case ActivityKind::Drop:
      agv_states_[agv.index()].plan.stay_due = true;  // from its beginning
      break;
    case ActivityKind::Dock:
      agv_states_[agv.index()].plan.dock_due = true;  // from its beginning
      break;
    case ActivityKind::Turn:
      agv_states_[agv.index()].plan.turn_ends_early = false;  // it ends here
      break;
    case ActivityKind::Settle:
      break;
    default:
      return;  // it stands already
  }
  ports_.activities.end(agv, false);
  continue_plan(agv, 0.0);
}

// If the agent goes on before the AGV stands, the turn ends all the same, and another one follows.
void Actions::brake_turn(AgvId agv) {
  const Piece turn = std::get<SpatialEvolution>(run_.status(agv).activity->evolution).piece;
  const MotionLimits limits = run_.type_of(agv).turn.as_motion();
  const double rate_radps = turn.profile.speed(to_seconds(run_.now - turn.begin));
  const double way_rad = rate_radps * rate_radps / (2.0 * limits.deceleration_mps2);
  Piece piece = run_.standing_piece(agv, run_.pose_now(agv));
  piece.manner = Manner::Turn;
  piece.turn_rad = std::copysign(way_rad, turn.turn_rad);
  piece.profile = MotionProfile(way_rad, limits, {.entry_mps = rate_radps, .exit_mps = 0.0});
  piece.end = piece.begin + piece.profile.duration();
  agv_states_[agv.index()].plan.turn_ends_early = true;
  ports_.activities.continue_with(agv, piece);
}

void Actions::go_on(AgvId agv) {
  if (run_.status(agv).is_driving()) return ports_.drives.replan(agv);  // it was still braking
  AgvState& agv_state = agv_states_[agv.index()];
  if (!agv_state.waits) return;
  agv_state.waits = false;
  continue_plan(agv, 0.0);
}

void Actions::reshape(AgvId agv) {
  if (run_.status(agv).is_driving()) {
    ports_.drives.replan(agv);
  } else if (run_.world.body(agv).piece.manner == Manner::Rest) {
    ports_.activities.stand(agv, run_.pose_now(agv));
  }
}

bool Actions::stop_for_good(AgvId agv) {
  AgvStatus& status = run_.status(agv);
  AgvState& agv_state = agv_states_[agv.index()];
  if (status.out_of_order) return false;
  status.out_of_order = true;
  const int under_way = (agv_state.acting ? 1 : 0) + (agv_state.next ? 1 : 0);
  const bool on_lane = status.is_driving() || (agv_state.plan.drive_due && agv_state.plan.way_m > 0.0);
  status.stopped_on = agv_state.acting && on_lane ? agv_state.plan.lane : nullptr;
  if (status.activity) ports_.activities.end(agv, false);
  agv_state.plan = {};
  agv_state.next.reset();
  agv_state.waits = false;
  agv_state.doing = FP_OUT_OF_ORDER;
  agv_state.acting = false;
  agv_state.committed = agv_state.accepted;  // an accepted call sends its own answer when it takes effect
  for (int i = 0; i < under_way; ++i) tell_done(agv, FP_REFUSED);
  return true;
}

void Actions::put_back(AgvId agv, StationId station) {
  AgvStatus& status = run_.status(agv);
  status.station = station;
  status.out_of_order = false;
  agv_states_[agv.index()].doing = FP_IDLE;
  run_.progressed(agv);
}

// ---- what others may know

fp_action Actions::doing(AgvId agv) const {
  const AgvStatus& status = run_.status(agv);
  if (status.out_of_order || std::ranges::any_of(status.halts, &Halt::out_of_order)) return FP_OUT_OF_ORDER;
  return status.halts.empty() || status.activity ? agv_states_[agv.index()].doing : FP_STOPPED;
}

LanesAhead Actions::lanes(AgvId agv) const {
  const AgvState& agv_state = agv_states_[agv.index()];
  return {.current = agv_state.acting || agv_state.committed ? agv_state.plan.lane : nullptr,
          .next = agv_state.next ? agv_state.next->lane : nullptr,
          .still_to_drive = agv_state.acting && (run_.status(agv).is_driving() || agv_state.plan.drive_due)};
}

}  // namespace fleetproof
