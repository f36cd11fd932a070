// The protective field of an AGV: looked at every reaction time while it drives or stands because of it.
#include <algorithm>

#include "core/engine.hpp"

namespace fleetproof {

void Engine::scanner_wakes(Agv& agv) { queue_.push(now_, agv.id, Event::Kind::ScannerLooks, 0, ++agv.scanner_stamp); }

OrientedRectangle Engine::protective_field(const Agv& agv) const {
  const ScannerSetup& scanner = scenario_.scanner;
  const Piece& piece = world_.body(agv.id).piece;
  const double speed = piece.speed_at(now_), braking = type_of(agv).drive_with(is_loaded(agv)).deceleration_mps2;
  const double length_m = speed * scanner.reaction_s + speed * speed / (2.0 * braking) + scanner.margin_m;
  const OrientedRectangle body = piece.body_at(now_);
  return {body.centre_m + (body.half_length_m + 0.5 * length_m) * body.heading, body.heading, 0.5 * length_m, body.half_width_m + scanner.margin_m};
}

// The first body, by number, that stands in the field.
std::optional<EntityId> Engine::intruder(const Agv& agv) const {
  const OrientedRectangle field = protective_field(agv);
  for (std::size_t i = 0; i < world_.body_count(); ++i) {
    const Body& body = world_.body(EntityId{i});
    if (body.on_floor && EntityId{i} != agv.id && clearance_m(field, body.piece.body_at(now_)) <= 0.0) return EntityId{i};
  }
  return std::nullopt;
}

void Engine::scanner_looks(Agv& agv) {
  const bool driving = agv.activity && agv.activity->kind == ActivityKind::Drive;
  const bool held = std::ranges::find(agv.halts, Halt::Reason::Scanner, &Halt::reason) != agv.halts.end();
  if (agv.out_of_order || (!driving && !held)) return;  // it wakes with the next drive
  const auto body = intruder(agv);
  if (!body) agv.scanner_muted = false;
  if (body && !held && !agv.scanner_muted) {
    scanner_stops(agv, *body);
  } else if (held && body) {
    agv.field_clear_since.reset();
  } else if (held) {
    if (!agv.field_clear_since) agv.field_clear_since = now_;
    if (now_ - *agv.field_clear_since >= seconds(scenario_.scanner.resume_s)) end_halts(agv, Halt::Reason::Scanner);
  }
  const std::uint64_t stamp = agv.scanner_stamp;  // a new drive may have woken it meanwhile
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
  halt(agv, Halt::Reason::Scanner);
  call_operator(agv, Assist::Jam);
}

}  // namespace fleetproof
