#include "core/engine/activities.hpp"

#include "core/engine/contacts.hpp"
#include "core/engine/fault_injector.hpp"
#include "core/outcome/work_and_progress.hpp"

namespace fleetproof {

Activities::Activities(RunContext& run, const Ports& ports) : run_(run), ports_(ports), stamps_(run.agvs.size()) {}

void Activities::begin(AgvId agv, const Activity& activity, std::uint64_t subject) {
  run_.trace(agv, traced::ActivityBegins{activity.kind, subject});
  run_.queue.push(activity.end, agv, Event::Kind::ActivityEnds, 0, ++stamps_[agv.index()]);
  run_.status(agv).activity = activity;
  ports_.battery.activity_changed(agv, activity.kind == ActivityKind::Drive);
}

void Activities::begin_moving(AgvId agv, ActivityKind kind, const Piece& piece, std::uint64_t subject) {
  set_piece(agv, piece);
  begin(agv, {kind, agv, piece.begin, piece.end, SpatialEvolution{piece}}, subject);
  ports_.contacts.predict(agv);
}

void Activities::continue_with(AgvId agv, const Piece& piece) {
  ports_.battery.settle(agv);
  Activity& activity = *run_.status(agv).activity;
  activity.evolution = SpatialEvolution{piece};
  activity.end = piece.end;
  set_piece(agv, piece);
  run_.queue.push(piece.end, agv, Event::Kind::ActivityEnds, 0, ++stamps_[agv.index()]);
  ports_.contacts.predict(agv);
  ports_.battery.activity_changed(agv, false);
}

void Activities::end(AgvId agv, bool as_planned) {
  const Activity activity = take_off(agv);
  if (const auto* spatial = std::get_if<SpatialEvolution>(&activity.evolution)) {
    stand(agv, spatial->piece.pose_at(run_.now));
  } else if (const auto* containment = std::get_if<ContainmentEvolution>(&activity.evolution)) {
    if (as_planned) transfer(agv, *containment);
  }
  announce_end(agv, activity.kind, as_planned);
}

void Activities::end_turn_at(AgvId agv, const Vec2& heading) {
  const Activity activity = take_off(agv);
  stand(agv, {std::get<SpatialEvolution>(activity.evolution).piece.start.position_m, heading});
  announce_end(agv, activity.kind, true);
}

void Activities::end_rolling(AgvId agv) {
  ports_.battery.settle(agv);
  run_.status(agv).activity.reset();
  ++stamps_[agv.index()];
  run_.trace(agv, traced::ActivityEnds{ActivityKind::Drive, true});
}

Activity Activities::take_off(AgvId agv) {
  ports_.battery.settle(agv);
  AgvStatus& status = run_.status(agv);
  const Activity activity = *status.activity;
  status.activity.reset();
  ++stamps_[agv.index()];
  if (is_work(activity.kind)) run_.progressed(agv);
  return activity;
}

void Activities::announce_end(AgvId agv, ActivityKind kind, bool as_planned) {
  run_.trace(agv, traced::ActivityEnds{kind, as_planned});
  ports_.battery.activity_changed(agv, false);
}

void Activities::set_piece(AgvId agv, const Piece& piece) {
  ports_.sensor.piece_ends(agv);
  ports_.messenger.piece_begins(piece);
  run_.world.continue_with(agv, piece);
}

void Activities::stand(AgvId agv, const Pose& pose) {
  set_piece(agv, run_.standing_piece(agv, pose));
  ports_.contacts.predict(agv);
}

void Activities::transfer(AgvId agv, const ContainmentEvolution& evolution) {
  if (!evolution.load.valid()) return;
  const Load& load = run_.world.load(evolution.load);
  const bool is_drop = evolution.to.kind == Holder::Kind::Station;
  if (is_drop && load.holder != Holder{Holder::Kind::Agv, agv.value}) return;  // it fell off meanwhile
  // Another AGV has taken it up meanwhile, or it was withdrawn.
  if (!is_drop && !run_.world.is_waiting(evolution.load, agv, run_.status(agv).station)) return;
  run_.move_load(evolution.load, evolution.to);
  if (run_.type_of(agv).loaded != LoadEffect{}) stand(agv, run_.pose_now(agv));  // the body has grown or shrunk
  if (!is_drop) {
    ports_.faults.load_taken_up(agv, load.transport);
  } else if (load.is_delivered()) {
    ++run_.counters.transports_done;
    run_.trace(agv, traced::TransportDone{load.transport});
  }
}

}  // namespace fleetproof
