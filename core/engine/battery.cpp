#include "core/engine/battery.hpp"

#include <algorithm>
#include <cmath>

#include "core/engine/operator_desk.hpp"

namespace fleetproof {
namespace {

const Piece& driven_piece(const AgvStatus& status) {
  return std::get<SpatialEvolution>(status.activity->evolution).piece;
}

}  // namespace

Battery::Battery(RunContext& run, const Ports& ports) : run_(run), ports_(ports), slices_(run.agvs.size()) {
  for (std::size_t i = 0; i < slices_.size(); ++i) slices_[i].level = run.scenario.agvs[i].battery;
}

// What the AGV has used and got since its account was last settled, up to `t`.
Battery::Book Battery::use_until(AgvId agv, SimTime t) const {
  const Slice& slice = slices_[agv.index()];
  const AgvStatus& status = run_.status(agv);
  const VehicleType& type = run_.type_of(agv);
  Book use;
  const double elapsed_s = to_seconds(t - slice.at);
  const auto* charge = status.activity ? std::get_if<BatteryEvolution>(&status.activity->evolution) : nullptr;
  if (charge != nullptr) {
    use.charged = charge->per_s * elapsed_s;
    return use;
  }
  use.idled = type.battery_idle_per_s * elapsed_s;
  if (status.is_driving()) use.driven = (driven_piece(status).way_at(t) - slice.way_m) * type.battery_per_m;
  return use;
}

double Battery::level(AgvId agv) const {
  const Book use = use_until(agv, run_.now);
  return std::clamp(slices_[agv.index()].level - use.driven - use.idled + use.charged, 0.0, 1.0);
}

void Battery::settle(AgvId agv) {
  Slice& slice = slices_[agv.index()];
  const AgvStatus& status = run_.status(agv);
  Book use = use_until(agv, run_.now);
  // The level stays between empty and full. An AGV with an empty battery brakes by springs, and a full battery is not
  // charged.
  use.charged = std::min(use.charged, 1.0 - slice.level);
  use.driven = std::min(use.driven, slice.level + use.charged);
  use.idled = std::min(use.idled, std::max(0.0, slice.level + use.charged - use.driven));
  slice.level = slice.level - use.driven - use.idled + use.charged;
  slice.at = run_.now;
  slice.book.driven += use.driven;
  slice.book.idled += use.idled;
  slice.book.charged += use.charged;
  if (!status.is_driving()) return;
  const double way_m = driven_piece(status).way_at(run_.now);
  slice.driven_m += way_m - slice.way_m;
  slice.way_m = way_m;
}

void Battery::activity_changed(AgvId agv, bool drive_begins) {
  if (drive_begins) slices_[agv.index()].way_m = driven_piece(run_.status(agv)).way_begin_m;
  predict_empty(agv);
}

// Sets the event of running empty within the activity under way, or while the AGV stands.
void Battery::predict_empty(AgvId agv) {
  Slice& slice = slices_[agv.index()];
  const AgvStatus& status = run_.status(agv);
  ++slice.stamp;
  const SimTime end = std::min(status.is_driving() ? status.activity->end : kForever, kStart + run_.scenario.horizon);
  const auto empty_at = [&](SimTime t) {
    const Book use = use_until(agv, t);
    return slice.level - use.driven - use.idled + use.charged <= 0.0;
  };
  if (slice.out || end <= run_.now || !empty_at(end)) return;
  SimTime before = run_.now - Duration{1}, at = end;  // bisection to the nanosecond
  while (at - before > Duration{1}) {
    const SimTime middle = before + (at - before) / 2;
    (empty_at(middle) ? at : before) = middle;
  }
  run_.queue.push(at, agv, Event::Kind::BatteryEmpty, 0, slice.stamp);
}

void Battery::runs_empty(AgvId agv, std::uint64_t stamp) {
  Slice& slice = slices_[agv.index()];
  if (stamp != slice.stamp || run_.status(agv).out_of_order) return;
  settle(agv);
  slice.out = true;
  ++run_.counters.batteries_empty;
  run_.trace(agv, traced::BatteryEmpty{});
  ports_.operator_desk.call(agv, Assist::Battery, ports_.halts.begin(agv, Halt::Reason::EmptyBattery));
}

void Battery::change(AgvId agv, double level) {
  settle(agv);
  Slice& slice = slices_[agv.index()];
  slice.book.charged += level - slice.level;
  slice.level = level;
  slice.out = false;
  predict_empty(agv);
}

// Sums over the fleet, each rounded once.
void Battery::close_books() {
  double driven_m = 0.0, start = 0.0, end = 0.0;
  Book book;
  for (std::size_t i = 0; i < slices_.size(); ++i) {
    settle(AgvId{i});
    driven_m += slices_[i].driven_m;
    start += run_.scenario.agvs[i].battery;
    end += slices_[i].level;
    book.driven += slices_[i].book.driven;
    book.idled += slices_[i].book.idled;
    book.charged += slices_[i].book.charged;
  }
  const auto ppb = [](double share) { return static_cast<std::uint64_t>(std::llround(share * 1e9)); };
  Counters& counters = run_.counters;
  counters.distance_um = static_cast<std::uint64_t>(std::llround(driven_m * 1e6));
  counters.battery_start_ppb = ppb(start);
  counters.battery_end_ppb = ppb(end);
  counters.battery_driven_ppb = ppb(book.driven);
  counters.battery_idled_ppb = ppb(book.idled);
  counters.battery_charged_ppb = ppb(book.charged);
}

}  // namespace fleetproof
