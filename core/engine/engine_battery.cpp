// The battery of an AGV: linear in the way driven and in time, an account that every activity settles.
#include <algorithm>

#include "core/engine/engine.hpp"

namespace fleetproof {
namespace {

struct Use {
  double driven = 0.0, idled = 0.0, charged = 0.0;
  double level(double before) const { return before - driven - idled + charged; }
};

// What the AGV has used and got since its account was last settled, up to `t`.
Use use_until(const Agv& agv, const VehicleType& type, SimTime t) {
  Use use;
  const double elapsed_s = to_seconds(t - agv.battery_at);
  const auto* charge = agv.activity ? std::get_if<BatteryEvolution>(&agv.activity->evolution) : nullptr;
  if (charge != nullptr) {
    use.charged = charge->per_s * elapsed_s;
    return use;
  }
  use.idled = type.battery_idle_per_s * elapsed_s;
  if (agv.activity && agv.activity->kind == ActivityKind::Drive) {
    const Piece& piece = std::get<SpatialEvolution>(agv.activity->evolution).piece;
    use.driven = (piece.way_at(t) - agv.battery_way_m) * type.battery_per_m;
  }
  return use;
}

}  // namespace

double Engine::battery_of(const Agv& agv) const {
  return std::clamp(use_until(agv, type_of(agv), now_).level(agv.battery), 0.0, 1.0);
}

void Engine::settle_battery(Agv& agv) {
  Use use = use_until(agv, type_of(agv), now_);
  // What is not there cannot be used: an AGV that brakes with an empty battery does so by springs. Nor is a full one
  // filled.
  use.charged = std::min(use.charged, 1.0 - agv.battery);
  use.driven = std::min(use.driven, agv.battery + use.charged);
  use.idled = std::min(use.idled, std::max(0.0, agv.battery + use.charged - use.driven));
  agv.battery = use.level(agv.battery);
  agv.battery_at = now_;
  agv.book.driven += use.driven;
  agv.book.idled += use.idled;
  agv.book.charged += use.charged;
  if (agv.activity && agv.activity->kind == ActivityKind::Drive) {
    const double way_m = std::get<SpatialEvolution>(agv.activity->evolution).piece.way_at(now_);
    agv.driven_m += way_m - agv.battery_way_m;
    agv.battery_way_m = way_m;
  }
}

// Sets the event of running empty within the activity under way, or while the AGV stands.
void Engine::predict_empty_battery(Agv& agv) {
  ++agv.battery_stamp;
  const VehicleType& type = type_of(agv);
  const SimTime end = std::min(agv.activity && agv.activity->kind == ActivityKind::Drive ? agv.activity->end : kForever,
                               kStart + scenario_.horizon);
  const auto empty_at = [&](SimTime t) { return use_until(agv, type, t).level(agv.battery) <= 0.0; };
  if (agv.battery_out || end <= now_ || !empty_at(end)) return;
  SimTime before = now_ - Duration{1}, at = end;  // bisection to the nanosecond
  while (at - before > Duration{1}) {
    const SimTime middle = before + (at - before) / 2;
    (empty_at(middle) ? at : before) = middle;
  }
  queue_.push(at, agv.id, Event::Kind::BatteryEmpty, 0, agv.battery_stamp);
}

void Engine::battery_empty(Agv& agv) {
  if (agv.out_of_order) return;
  settle_battery(agv);
  agv.battery_out = true;
  ++outcome_.counters.batteries_empty;
  trace(agv.id, TraceKind::BatteryEmpty);
  call_operator(agv, Assist::Battery, halt(agv, Halt::Reason::EmptyBattery));
}

}  // namespace fleetproof
