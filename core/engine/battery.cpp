#include "core/engine/battery.hpp"

#include <algorithm>
#include <cmath>

#include "core/engine/operator_actions.hpp"

namespace fleetproof {
namespace {

const Piece& driven_piece(const AgvStatus& status) {
  return std::get<SpatialEvolution>(status.activity->evolution).piece;
}

}  // namespace

Battery::Battery(RunContext& run, const Ports& ports) : run_(run), ports_(ports), agv_states_(run.agvs.size()) {
  for (std::size_t i = 0; i < agv_states_.size(); ++i) agv_states_[i].level = run.scenario.agvs[i].battery;
}

// What the AGV has used and got since its account was last settled, up to `t`.
Battery::EnergyUse Battery::use_until(AgvId agv, SimTime t) const {
  const AgvState& agv_state = agv_states_[agv.index()];
  const AgvStatus& status = run_.status(agv);
  const VehicleType& type = run_.type_of(agv);
  EnergyUse use;
  const double elapsed_s = to_seconds(t - agv_state.at);
  const auto* charge = status.activity ? std::get_if<BatteryEvolution>(&status.activity->evolution) : nullptr;
  if (charge != nullptr) {
    use.charged = charge->per_s * elapsed_s;
    return use;
  }
  use.idled = type.battery_idle_per_s * elapsed_s;
  if (status.is_driving()) use.driven = (driven_piece(status).way_at(t) - agv_state.way_m) * type.battery_per_m;
  return use;
}

double Battery::level(AgvId agv) const {
  const EnergyUse use = use_until(agv, run_.now);
  return std::clamp(agv_states_[agv.index()].level - use.driven - use.idled + use.charged, 0.0, 1.0);
}

void Battery::settle(AgvId agv) {
  AgvState& agv_state = agv_states_[agv.index()];
  const AgvStatus& status = run_.status(agv);
  EnergyUse use = use_until(agv, run_.now);
  // The level stays between empty and full. An AGV with an empty battery brakes by springs, and a full battery is not
  // charged.
  use.charged = std::min(use.charged, 1.0 - agv_state.level);
  use.driven = std::min(use.driven, agv_state.level + use.charged);
  use.idled = std::min(use.idled, std::max(0.0, agv_state.level + use.charged - use.driven));
  agv_state.level = agv_state.level - use.driven - use.idled + use.charged;
  agv_state.at = run_.now;
  agv_state.used.driven += use.driven;
  agv_state.used.idled += use.idled;
  agv_state.used.charged += use.charged;
  if (!status.is_driving()) return;
  const double way_m = driven_piece(status).way_at(run_.now);
  agv_state.driven_m += way_m - agv_state.way_m;
  agv_state.way_m = way_m;
}

void Battery::activity_changed(AgvId agv, bool drive_begins) {
  if (drive_begins) agv_states_[agv.index()].way_m = driven_piece(run_.status(agv)).way_begin_m;
  predict_empty(agv);
}

// Sets the event of running empty within the activity under way, or while the AGV stands.
void Battery::predict_empty(AgvId agv) {
  AgvState& agv_state = agv_states_[agv.index()];
  const AgvStatus& status = run_.status(agv);
  ++agv_state.stamp;
  const SimTime end = std::min(status.is_driving() ? status.activity->end : kForever, kStart + run_.scenario.horizon);
  const auto empty_at = [&](SimTime t) {
    const EnergyUse use = use_until(agv, t);
    return agv_state.level - use.driven - use.idled + use.charged <= 0.0;
  };
  if (agv_state.out || end <= run_.now || !empty_at(end)) return;
  SimTime before = run_.now - Duration{1}, at = end;  // bisection to the nanosecond
  while (at - before > Duration{1}) {
    const SimTime middle = before + (at - before) / 2;
    (empty_at(middle) ? at : before) = middle;
  }
  run_.queue.push(at, agv, Event::Kind::BatteryEmpty, 0, agv_state.stamp);
}

void Battery::runs_empty(AgvId agv, std::uint64_t stamp) {
  AgvState& agv_state = agv_states_[agv.index()];
  if (stamp != agv_state.stamp || run_.status(agv).out_of_order) return;
  settle(agv);
  agv_state.out = true;
  ++run_.counters.batteries_empty;
  run_.trace(agv, traced::BatteryEmpty{});
  ports_.operator_actions.call(agv, Assist::Battery, ports_.halts.begin(agv, Halt::Reason::EmptyBattery));
}

void Battery::change(AgvId agv, double level) {
  settle(agv);
  AgvState& agv_state = agv_states_[agv.index()];
  agv_state.used.charged += level - agv_state.level;
  agv_state.level = level;
  agv_state.out = false;
  predict_empty(agv);
}

// Sums over the fleet, each rounded once.
void Battery::settle_accounts() {
  double driven_m = 0.0, start = 0.0, end = 0.0;
  EnergyUse used;
  for (std::size_t i = 0; i < agv_states_.size(); ++i) {
    settle(AgvId{i});
    driven_m += agv_states_[i].driven_m;
    start += run_.scenario.agvs[i].battery;
    end += agv_states_[i].level;
    used.driven += agv_states_[i].used.driven;
    used.idled += agv_states_[i].used.idled;
    used.charged += agv_states_[i].used.charged;
  }
  const auto ppb = [](double share) { return static_cast<std::uint64_t>(std::llround(share * 1e9)); };
  Counters& counters = run_.counters;
  counters.distance_um = static_cast<std::uint64_t>(std::llround(driven_m * 1e6));
  counters.battery_start_ppb = ppb(start);
  counters.battery_end_ppb = ppb(end);
  counters.battery_driven_ppb = ppb(used.driven);
  counters.battery_idled_ppb = ppb(used.idled);
  counters.battery_charged_ppb = ppb(used.charged);
}

}  // namespace fleetproof
