#include "core/engine/fault_injector.hpp"

#include <algorithm>
#include <utility>

#include "core/engine/contacts.hpp"

namespace fleetproof {
namespace {

Halt::Reason halt_of(Fault::Kind kind) {
  return kind == Fault::Kind::ProtectiveStop ? Halt::Reason::ProtectiveStop : Halt::Reason::Breakdown;
}

}  // namespace

FaultInjector::FaultInjector(RunContext& run, const Ports& ports)
    : run_(run), ports_(ports), fault_states_(run.scenario.faults.size()) {}

void FaultInjector::schedule() {
  const Scenario& scenario = run_.scenario;
  for (std::size_t i = 0; i < scenario.faults.size(); ++i) {
    const Fault& fault = scenario.faults[i];
    if (!fault.transport) run_.queue.push(kStart + fault.at, fault.agv, Event::Kind::FaultStrikes, i);
  }
  for (std::size_t i = 0; i < scenario.obstacles.size(); ++i) {
    const EntityId id{scenario.first_obstacle().index() + i};
    const ObstacleSetup& obstacle = scenario.obstacles[i];
    if (obstacle.appears > Duration::zero()) run_.queue.push(kStart + obstacle.appears, id, Event::Kind::BodyAppears);
    if (obstacle.leaves < scenario.horizon) run_.queue.push(kStart + obstacle.leaves, id, Event::Kind::BodyLeaves);
  }
}

void FaultInjector::load_taken_up(AgvId agv, TransportId transport) {
  for (std::size_t i = 0; i < fault_states_.size(); ++i) {
    const Fault& fault = run_.scenario.faults[i];
    if (!is_of(fault, transport) || fault_states_[i].came) continue;
    fault_states_[i].came = true;  // the first time that the load is taken up
    run_.queue.push(run_.now + fault.at, agv, Event::Kind::FaultStrikes, i);
  }
}

// An AGV or agent that is already out of order cannot fail.
std::optional<Denial> FaultInjector::denial_of(AgvId agv, std::uint64_t number) {
  const Fault& fault = run_.scenario.faults[number];
  const Fault::Kind kind = fault.kind;
  if (concerns_agent_alone(kind) || run_.scenario.is_computer(agv)) {
    if (!ports_.agents.is_up(agv)) return Denial::AgentAway;
    return kind == Fault::Kind::Named ? ports_.agents.why_not_told(agv, fault.word) : std::nullopt;
  }
  if (run_.status(agv).out_of_order) return Denial::OutOfOrder;
  return kind == Fault::Kind::LoadDrop ? load_drops(agv, number) : std::nullopt;
}

void FaultInjector::strikes(AgvId agv, std::uint64_t number) {
  const Fault& fault = run_.scenario.faults[number];
  if (const auto why = denial_of(agv, number)) return run_.deny(agv, *why, number);
  ++run_.counters.faults;
  run_.trace(agv, traced::FaultStrikes{fault.kind, number});
  if (holds(agv, fault.kind)) {
    fault_states_[number].halt = ports_.halts.begin(agv, halt_of(fault.kind));
    fault_states_[number].agv = agv;
  }
  if (stops_computer(fault.kind)) ports_.agents.goes_away(agv);
  if (fault.kind == Fault::Kind::DiskLoss) ports_.disks.lose(agv);
  if (fault.kind == Fault::Kind::Freeze) ports_.agents.freeze_until(agv, run_.now + fault.lasts);
  if (fault.kind == Fault::Kind::Named) ports_.agents.tell_fault(agv, fault);
  run_.queue.push(run_.now + fault.lasts, agv, Event::Kind::FaultOver, number);
}

void FaultInjector::ends(AgvId agv, std::uint64_t number) {
  const Fault& fault = run_.scenario.faults[number];
  const Fault::Kind kind = fault.kind;
  if (holds(agv, kind)) {
    halt_ends(agv, number);
  } else {
    run_.trace(agv, traced::FaultOver{kind, number});
  }
  if (stops_computer(kind)) ports_.agents.comes_back(agv);
}

void FaultInjector::end_halts_of(AgvId agv) {
  for (std::size_t i = 0; i < fault_states_.size(); ++i) {
    if (fault_states_[i].agv == agv) halt_ends(agv, i);
  }
}

// At its planned time, or earlier, when the operator helps.
void FaultInjector::halt_ends(AgvId agv, std::uint64_t number) {
  const std::uint64_t halt = std::exchange(fault_states_[number].halt, std::uint64_t{0});
  if (halt == 0) return;
  run_.trace(agv, traced::FaultOver{run_.scenario.faults[number].kind, number});
  ports_.halts.end(agv, halt);
}

// ---- bodies that come and go

void FaultInjector::obstacle_appears(EntityId body) {
  const ObstacleSetup& obstacle = run_.scenario.obstacle(body);
  if (run_.now >= kStart + obstacle.leaves) return;
  const double margin_m = run_.scenario.law.safety_distance_m + kAppearsClear_m;
  if (!run_.world.is_free(placed(obstacle.footprint, obstacle.pose), margin_m, run_.now)) {
    if (run_.now == kStart + obstacle.appears) run_.deny(body, Denial::NoRoom, 0);
    return run_.queue.push(run_.now + kBodyTriesAgain, body, Event::Kind::BodyAppears);
  }
  run_.trace(body, traced::Appears{});
  run_.world.put_on_floor(body, obstacle.footprint, obstacle.pose, run_.now);
  ports_.contacts.predict(body);
}

void FaultInjector::body_leaves(EntityId body) {
  if (!run_.world.body(body).on_floor) return;
  run_.trace(body, traced::Leaves{});
  run_.world.take_off_floor(body, run_.now);
  for (std::size_t i = 0; i < run_.world.loads().size(); ++i) {
    if (run_.world.loads()[i].holder != Holder{Holder::Kind::Floor, body.value}) continue;
    run_.move_load(LoadId{i}, {Holder::Kind::ClearedAway, 0});
    ++run_.counters.loads_cleared;
    ++run_.counters.assists;
  }
}

// The bodies of loads are numbered behind the obstacles, in order of their faults.
EntityId FaultInjector::fallen_body(std::uint64_t number) const {
  const auto& faults = run_.scenario.faults;
  const auto is_drop = [](const Fault& f) { return f.kind == Fault::Kind::LoadDrop; };
  const auto before = std::count_if(faults.begin(), faults.begin() + static_cast<std::ptrdiff_t>(number), is_drop);
  return EntityId{run_.scenario.first_fallen_load().index() + static_cast<std::size_t>(before)};
}

// A load that would fall on another body, or on its own AGV, does not fall.
std::optional<Denial> FaultInjector::load_drops(AgvId agv, std::uint64_t number) {
  const Fault& fault = run_.scenario.faults[number];
  const LoadId load = run_.world.carried_load(agv);
  if (!load.valid()) return Denial::NoSuchLoad;
  if (fault.transport && !is_of(fault, run_.world.load(load).transport))
    return Denial::NoSuchLoad;  // the fault belongs to another transport
  const OrientedRectangle from = run_.world.body(agv).piece.body_at(run_.now);
  const Pose pose{from.centre_m + fault.ahead_m * from.heading + fault.left_m * left_of(from.heading), from.heading};
  if (!run_.world.is_free(placed(fault.load, pose), run_.scenario.law.safety_distance_m, run_.now))
    return Denial::NoRoom;
  const EntityId body = fallen_body(number);
  run_.move_load(load, {Holder::Kind::Floor, body.value});
  ports_.actions.reshape(agv);
  run_.trace(body, traced::Appears{});
  run_.world.put_on_floor(body, fault.load, pose, run_.now);
  ports_.contacts.predict(body);
  run_.queue.push(run_.now + fault.lasts, body, Event::Kind::BodyLeaves);
  return std::nullopt;
}

}  // namespace fleetproof
