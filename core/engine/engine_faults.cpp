// Faults strike, bodies come and go, an AGV halts wherever it is and goes on.
#include <algorithm>
#include <utility>

#include "core/base/error.hpp"
#include "core/engine/engine.hpp"

namespace fleetproof {
namespace {

constexpr double kAppearsClear_m = 0.05;  // beyond the safety distance
constexpr Duration kTriesAgain = std::chrono::seconds(1);

Halt::Reason halt_of(Fault::Kind kind) {
  return kind == Fault::Kind::Breakdown ? Halt::Reason::Breakdown : Halt::Reason::ProtectiveStop;
}

}  // namespace

void Engine::schedule_faults() {
  fault_halts_.resize(scenario_.faults.size());
  fault_came_.resize(scenario_.faults.size());
  for (std::size_t i = 0; i < scenario_.faults.size(); ++i) {
    const Fault& fault = scenario_.faults[i];
    if (!fault.transport) queue_.push(kStart + fault.at, fault.agv, Event::Kind::FaultStrikes, i);
  }
  for (std::size_t i = 0; i < scenario_.obstacles.size(); ++i) {
    const EntityId id{scenario_.agvs.size() + i};
    const ObstacleSetup& obstacle = scenario_.obstacles[i];
    if (obstacle.appears > Duration::zero()) queue_.push(kStart + obstacle.appears, id, Event::Kind::BodyAppears);
    if (obstacle.leaves < scenario_.horizon) queue_.push(kStart + obstacle.leaves, id, Event::Kind::BodyLeaves);
  }
}

void Engine::load_taken_up(const Agv& agv, TransportId transport) {
  const std::uint64_t own = transport.value - first_transport_[agv.id.index()];
  for (std::size_t i = 0; i < scenario_.faults.size(); ++i) {
    const Fault& fault = scenario_.faults[i];
    if (fault.agv != agv.id || fault.transport != own || fault_came_[i]) continue;
    fault_came_[i] = true;  // the first time that it is taken up
    queue_.push(now_ + fault.at, agv.id, Event::Kind::FaultStrikes, i);
  }
}

void Engine::fault_strikes(Agv& agv, std::uint64_t number) {
  const Fault& fault = scenario_.faults[number];
  const bool agents = fault.kind == Fault::Kind::Restart || fault.kind == Fault::Kind::Freeze;
  if (agents ? agv.agent_failed || agv.agent_away > 0 : agv.out_of_order)
    return;  // what is out of order already cannot fail
  if (fault.kind == Fault::Kind::LoadDrop && !load_drops(agv, fault, number)) return;
  ++outcome_.counters.faults;
  trace(agv.id, TraceKind::FaultStrikes, static_cast<std::uint64_t>(fault.kind), number);
  if (holds_agv(fault.kind)) fault_halts_[number] = halt(agv, halt_of(fault.kind));
  if (fault.kind == Fault::Kind::Restart) agent_goes_away(agv);
  if (fault.kind == Fault::Kind::Freeze) agv.free_at = std::max(agv.free_at, now_ + fault.lasts);
  queue_.push(now_ + fault.lasts, agv.id, Event::Kind::FaultOver, number);
}

void Engine::fault_over(Agv& agv, std::uint64_t number) {
  const Fault& fault = scenario_.faults[number];
  if (holds_agv(fault.kind)) return fault_halt_ends(agv, number);
  trace(agv.id, TraceKind::FaultOver, static_cast<std::uint64_t>(fault.kind), number);
  if (fault.kind == Fault::Kind::Restart) agent_comes_back(agv);
}

// At its time, or before it in the hands of the operator.
void Engine::fault_halt_ends(Agv& agv, std::uint64_t number) {
  const std::uint64_t halt = std::exchange(fault_halts_[number], std::uint64_t{0});
  if (halt == 0) return;
  trace(agv.id, TraceKind::FaultOver, static_cast<std::uint64_t>(scenario_.faults[number].kind), number);
  end_halt(agv, halt);
}

// ---- halts

std::uint64_t Engine::halt(Agv& agv, Halt::Reason reason) {
  agv.halts.push_back({reason, ++agv.halts_ever});
  const std::uint64_t number = agv.halts.back().number;
  if (agv.halts.size() > 1 || !agv.activity) return number;
  switch (agv.activity->kind) {
    case ActivityKind::Drive:
      replan_drive(agv);
      break;
    case ActivityKind::Pick:
    case ActivityKind::Drop:
      agv.plan.stay_due = true;  // from its beginning
      [[fallthrough]];
    case ActivityKind::Turn:
    case ActivityKind::Settle:
      end_activity(agv, false);
      continue_plan(agv, 0.0);
      break;
    default:
      break;  // it stands already
  }
  return number;
}

void Engine::end_halt(Agv& agv, std::uint64_t number) {
  if (std::erase_if(agv.halts, [&](const Halt& halt) { return halt.number == number; }) == 0 || !agv.halts.empty() ||
      agv.out_of_order)
    return;
  if (agv.activity && agv.activity->kind == ActivityKind::Drive) return replan_drive(agv);  // it was still braking
  progressed(agv);
  if (!agv.plan_waits) return;
  agv.plan_waits = false;
  continue_plan(agv, 0.0);
}

void Engine::end_halts(Agv& agv, Halt::Reason reason) {
  while (true) {
    const auto found = std::ranges::find(agv.halts, reason, &Halt::reason);
    if (found == agv.halts.end()) return;
    end_halt(agv, found->number);
  }
}

fp_action Engine::action_of(const Agv& agv) const {
  if (agv.out_of_order || std::ranges::any_of(agv.halts, &Halt::out_of_order)) return FP_OUT_OF_ORDER;
  return agv.halts.empty() || agv.activity ? agv.doing : FP_STOPPED;
}

// ---- bodies that come and go

void Engine::body_appears(EntityId id) {
  if (world_.body(id).is_agv) return look_for_place(agvs_[id.index()]);
  const ObstacleSetup& obstacle = scenario_.obstacles[id.index() - scenario_.agvs.size()];
  if (now_ >= kStart + obstacle.leaves) return;
  const double margin_m = scenario_.law.safety_distance_m + kAppearsClear_m;
  if (!world_.is_free(placed(obstacle.footprint, obstacle.pose), margin_m, now_)) {
    return queue_.push(now_ + kTriesAgain, id, Event::Kind::BodyAppears);
  }
  trace(id, TraceKind::Appears);
  world_.put_on_floor(id, obstacle.footprint, obstacle.pose, now_);
  predict_touches(id);
}

void Engine::body_leaves(EntityId id) {
  if (!world_.body(id).on_floor) return;
  trace(id, TraceKind::Leaves);
  world_.take_off_floor(id, now_);
  for (std::size_t i = 0; i < world_.loads().size(); ++i) {
    if (world_.loads()[i].holder != Holder{Holder::Kind::Floor, id.value}) continue;
    move_load(LoadId{i}, {Holder::Kind::ClearedAway, 0});
    ++outcome_.counters.loads_cleared;
    ++outcome_.counters.assists;
  }
}

// False if the AGV carries nothing, or the load would fall on something: then it does not fall.
bool Engine::load_drops(Agv& agv, const Fault& fault, std::uint64_t number) {
  const LoadId load = world_.carried_load(agv.id);
  if (!load.valid()) return false;
  if (fault.transport && world_.load(load).transport.value - first_transport_[agv.id.index()] != *fault.transport)
    return false;  // another one's
  const auto is_drop = [](const Fault& f) { return f.kind == Fault::Kind::LoadDrop; };
  const auto drops_before =
      std::count_if(scenario_.faults.begin(), scenario_.faults.begin() + static_cast<std::ptrdiff_t>(number), is_drop);
  const EntityId body{scenario_.agvs.size() + scenario_.obstacles.size() + static_cast<std::size_t>(drops_before)};
  const Pose from = world_.pose_of(agv.id, now_);
  const Pose pose{from.position_m + fault.ahead_m * from.heading + fault.left_m * left_of(from.heading), from.heading};
  if (!world_.is_free(placed(fault.load, pose), scenario_.law.safety_distance_m, now_)) return false;
  move_load(load, {Holder::Kind::Floor, body.value});
  if (agv.activity && agv.activity->kind == ActivityKind::Drive) {
    replan_drive(agv);  // with the smaller body
  } else if (world_.body(agv.id).piece.manner == Manner::Rest) {
    stand(agv, from);
  }
  trace(body, TraceKind::Appears);
  world_.put_on_floor(body, fault.load, pose, now_);
  predict_touches(body);
  queue_.push(now_ + fault.lasts, body, Event::Kind::BodyLeaves);
  return true;
}

void Engine::move_load(LoadId id, Holder to) {
  world_.load(id).holder = to;
  trace_load(id);
}

void Engine::trace_load(LoadId id) {
  const auto& [transport, carrier, holder, destination] = world_.load(id);
  trace(carrier, TraceKind::LoadMoves, id.value,
        (std::uint64_t{static_cast<std::uint32_t>(holder.kind)} << 32) | holder.index);
}

}  // namespace fleetproof
