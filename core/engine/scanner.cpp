#include "core/engine/scanner.hpp"

#include <algorithm>

#include "core/engine/contacts.hpp"
#include "core/engine/operator_actions.hpp"

namespace fleetproof {

Scanner::Scanner(RunContext& run, const Ports& ports) : run_(run), ports_(ports), agv_states_(run.agvs.size()) {}

void Scanner::drive_begins(AgvId agv) {
  run_.queue.push(run_.now, agv, Event::Kind::ScannerLooks, 0, ++agv_states_[agv.index()].stamp);
}

double Scanner::field_length_m(AgvId agv) const {
  const ScannerSetup& scanner = run_.scenario.scanner;
  const double speed = run_.world.body(agv).piece.speed_at(run_.now),
               braking = run_.type_of(agv).drive_with(run_.is_loaded(agv), false).deceleration_mps2;
  const double needed_m = speed * scanner.reaction_s + speed * speed / (2.0 * braking) + scanner.margin_m;
  return scanner.range_m > 0.0 ? std::min(needed_m, scanner.range_m) : needed_m;
}

// The first body, by number, that stands in the field.
std::optional<EntityId> Scanner::intruder(AgvId agv, double length_m) const {
  const OrientedRectangle own = run_.world.body(agv).piece.body_at(run_.now);
  const double sign = agv_states_[agv.index()].backward ? -1.0 : 1.0;
  const OrientedRectangle field{own.centre_m + sign * (own.half_length_m + 0.5 * length_m) * own.heading, own.heading,
                                0.5 * length_m, own.half_width_m + run_.scenario.scanner.margin_m};
  for (std::size_t i = 0; i < run_.world.entity_count(); ++i) {
    const Body& body = run_.world.body(EntityId{i});
    if (body.on_floor && EntityId{i} != agv && clearance_m(field, body.piece.body_at(run_.now)) <= 0.0)
      return EntityId{i};
  }
  return std::nullopt;
}

void Scanner::looks(AgvId agv, std::uint64_t stamp) {
  AgvState& agv_state = agv_states_[agv.index()];
  const AgvStatus& status = run_.status(agv);
  const bool held = status.is_held_by(Halt::Reason::Scanner);
  if (status.is_driving()) agv_state.backward = run_.world.body(agv).piece.moves_against_heading();
  // For an AGV that stands for another reason, the scanner starts to look when the next drive begins.
  if (stamp != agv_state.stamp || status.out_of_order || (!status.is_driving() && !held)) return;
  double length_m = field_length_m(agv);
  if (held || agv_state.muted)
    length_m = std::max(length_m, agv_state.field_m - (run_.pose_now(agv).position_m - agv_state.field_from_m).norm());
  const auto body = intruder(agv, length_m);
  if (!body) agv_state.muted = false;
  if (body && !held && !agv_state.muted) {
    stop(agv, *body);
  } else if (held && body) {
    agv_state.clear_since.reset();
  } else if (held) {
    wait_while_clear(agv);
  }
  run_.queue.push(run_.now + seconds(run_.scenario.scanner.reaction_s), agv, Event::Kind::ScannerLooks, 0, stamp);
}

void Scanner::wait_while_clear(AgvId agv) {
  auto& since = agv_states_[agv.index()].clear_since;
  if (!since) since = run_.now;
  if (run_.now - *since >= seconds(run_.scenario.scanner.resume_s)) ports_.halts.end_all(agv, Halt::Reason::Scanner);
}

void Scanner::stop(AgvId agv, EntityId body) {
  ++run_.counters.scanner_stops;
  run_.trace(agv, traced::ScannerStops{body});
  const bool touch_ahead = ports_.contacts.foresees(agv, body);
  AgvState& agv_state = agv_states_[agv.index()];
  agv_state.clear_since.reset();
  agv_state.field_m = field_length_m(agv);
  agv_state.field_from_m = run_.pose_now(agv).position_m;
  ports_.operator_actions.call(agv, Assist::Jam, ports_.halts.begin(agv, Halt::Reason::Scanner));
  // A stop that comes too late saves nobody.
  if (touch_ahead && !ports_.contacts.foresees(agv, body)) ++run_.counters.scanner_saves;
}

}  // namespace fleetproof
