// The protective field of an AGV: looked at every reaction time while it drives or stands because of it.
#include <algorithm>

#include "core/engine/engine.hpp"

namespace fleetproof {

void Engine::scanner_wakes(Agv& agv) { queue_.push(now_, agv.id, Event::Kind::ScannerLooks, 0, ++agv.scanner_stamp); }

double Engine::field_length_m(const Agv& agv) const {
  const ScannerSetup& scanner = scenario_.scanner;
  const double speed = world_.body(agv.id).piece.speed_at(now_),
               braking = type_of(agv).drive_with(is_loaded(agv)).deceleration_mps2;
  return speed * scanner.reaction_s + speed * speed / (2.0 * braking) + scanner.margin_m;
}

// The first body, by number, that stands in the field.
std::optional<EntityId> Engine::intruder(const Agv& agv, double length_m) const {
  const OrientedRectangle own = world_.body(agv.id).piece.body_at(now_);
  const OrientedRectangle field{own.centre_m + (own.half_length_m + 0.5 * length_m) * own.heading, own.heading,
                                0.5 * length_m, own.half_width_m + scenario_.scanner.margin_m};
  for (std::size_t i = 0; i < world_.body_count(); ++i) {
    const Body& body = world_.body(EntityId{i});
    if (body.on_floor && EntityId{i} != agv.id && clearance_m(field, body.piece.body_at(now_)) <= 0.0)
      return EntityId{i};
  }
  return std::nullopt;
}

void Engine::scanner_looks(Agv& agv) {
  const std::uint64_t stamp = agv.scanner_stamp;  // a drive that begins meanwhile wakes it anew
  const bool driving = agv.activity && agv.activity->kind == ActivityKind::Drive;
  const bool held = std::ranges::find(agv.halts, Halt::Reason::Scanner, &Halt::reason) != agv.halts.end();
  if (agv.out_of_order || (!driving && !held)) return;  // it wakes with the next drive
  double length_m = field_length_m(agv);
  if (held || agv.scanner_muted)
    length_m = std::max(length_m, agv.field_m - (world_.pose_of(agv.id, now_).position_m - agv.field_from_m).norm());
  const auto body = intruder(agv, length_m);
  if (!body) agv.scanner_muted = false;
  if (body && !held && !agv.scanner_muted) {
    scanner_stops(agv, *body);
  } else if (held && body) {
    agv.field_clear_since.reset();
  } else if (held) {
    if (!agv.field_clear_since) agv.field_clear_since = now_;
    if (now_ - *agv.field_clear_since >= seconds(scenario_.scanner.resume_s)) end_halts(agv, Halt::Reason::Scanner);
  }
  queue_.push(now_ + seconds(scenario_.scanner.reaction_s), agv.id, Event::Kind::ScannerLooks, 0, stamp);
}

void Engine::scanner_stops(Agv& agv, EntityId body) {
  ++outcome_.counters.scanner_stops;
  trace(agv.id, TraceKind::ScannerStops, body.value);
  const bool would_touch = std::ranges::any_of(touches_, [&](const TouchPrediction& touch) {
    const bool of_these = (touch.a == agv.id && touch.b == body) || (touch.a == body && touch.b == agv.id);
    return of_these && is_current(touch) && !world_.have_touched(touch.a, touch.b);
  });
  if (would_touch) ++outcome_.counters.scanner_saves;
  agv.field_clear_since.reset();
  agv.field_m = field_length_m(agv);
  agv.field_from_m = world_.pose_of(agv.id, now_).position_m;
  call_operator(agv, Assist::Jam, halt(agv, Halt::Reason::Scanner));
}

}  // namespace fleetproof
