#include "core/engine/agv_controller.hpp"

#include <algorithm>
#include <utility>

#include "core/base/random.hpp"
#include "core/engine/declarations.hpp"

namespace fleetproof {
namespace {

constexpr std::int64_t kDeclaredCostMax_ns = 3'600'000'000'000;  // an agent that thinks for an hour counts as hung

// A damaged recording may hold any count: the sum does not begin at zero again, which would reopen the limits.
void add(std::uint64_t count, std::uint64_t& sum) {
  constexpr std::uint64_t kLargest = std::uint64_t{1} << 62U;
  sum += std::min(count, kLargest - std::min(kLargest, sum));
}

// Whether this participant may make declarations about an AGV with this number.
bool may_speak_for(const Scenario& scenario, EntityId speaker, std::uint32_t agv) {
  return agv < scenario.agvs.size() && (speaker.value == agv || scenario.is_computer(speaker));
}

}  // namespace

AgvController::AgvController(RunContext& run, const Ports& ports)
    : run_(run),
      ports_(ports),
      call_cost_(seconds(run.scenario.agent_clock.call_cost_s)),
      random_key_(stream_key(run.scenario.seed_of(Stream::Agent), Stream::Agent)),
      agv_states_(run.scenario.participant_count()) {
  for (std::size_t i = 0; i < agv_states_.size(); ++i)
    agv_states_[i].handle = {.part = this,
                             .agv = EntityId{i},
                             .is_computer = run.scenario.is_computer(EntityId{i}),
                             .hears_notes = run.hears_notes()};
}

// ---- activations

void AgvController::begin_activation(fp_controller& handle) {
  handle.calls_max = kCallsMax;
  handle.calls = handle.services = 0;
  handle.cost = Duration::zero();
}

bool AgvController::end_activation(fp_controller& handle) {
  if (handle.hears_notes) [[unlikely]]
    ports_.declarations.end_activation(handle.agv);
  handle.calls_max = 0;
  run_.counters.agent_calls += handle.calls + handle.services;
  return handle.cost > Duration::zero() || handle.broken_limit() != nullptr;
}

// A tape ends here, so what follows must not count. The cost makes the host look at the activation.
void AgvController::fail(fp_controller& handle, bool hang, std::string_view text) {
  if (handle.failure != nullptr) return;
  handle.failure = std::make_unique<FiledFailure>();
  handle.failure->hang = hang;
  handle.failure->message = text;
  handle.failure->calls = handle.calls + handle.services;
  handle.tape = nullptr;
  handle.calls_max = 0;
  handle.cost = std::max(handle.cost, Duration{1});
}

void AgvController::forget(AgvId agv) {
  AgvState& agv_state = agv_states_[agv.index()];
  ports_.timers.forget(agv);
  ports_.messenger.forget_inbox(agv);
  for (PendingCall& call : agv_state.pending) {
    if (call.kind == PendingCall::Kind::Send) ports_.messenger.withdraw(call.message);
    call.kind = PendingCall::Kind::Nothing;  // its event still comes
  }
  if (!agv_state.handle.is_computer) ports_.actions.withdraw_accepted(agv);
  ports_.declarations.forget(agv);
  ports_.disks.forget(agv);
}

// ---- calls

bool AgvController::admit(fp_controller& handle) {
  // A call from outside an activation (another thread, a stored pointer) has no instant at which it could act.
  if (++handle.calls > handle.calls_max) [[unlikely]]
    return false;
  handle.cost += call_cost_;
  return true;
}

bool AgvController::admit_service(fp_controller& handle) {
  if (!handle.in_activation() || ++handle.services > kServicesMax) return false;
  handle.cost += call_cost_;
  return true;
}

bool AgvController::admit_note(AgvId agv) {
  return agv_states_[agv.index()].handle.in_activation() && ports_.declarations.admits_note(agv);
}

void AgvController::admit_services(AgvId agv, std::uint64_t count) {
  fp_controller& handle = agv_states_[agv.index()].handle;
  const std::uint64_t left = kServicesMax - std::min<std::uint64_t>(kServicesMax, handle.services);
  handle.cost += call_cost_ * static_cast<std::int64_t>(std::min(count, left));
  add(count, handle.services);
}

void AgvController::refuse(AgvId agv, std::uint64_t count) { add(count, agv_states_[agv.index()].handle.calls); }

inline void AgvController::carry_out(AgvId agv, const PendingCall& call) {
  switch (call.kind) {
    case PendingCall::Kind::Action:
      return ports_.actions.begin(agv, static_cast<fp_call>(call.what), call.segment, call.load);
    case PendingCall::Kind::Stop:
      return apply_stop(agv, call.what != 0);
    case PendingCall::Kind::Send:
      return ports_.messenger.transmit(agv, call.message, call.what);
    case PendingCall::Kind::SafeMode:
      return ports_.declarations.set_safe_mode(agv, call.what != 0);
    case PendingCall::Kind::WaitingFor:
      return ports_.declarations.set_waiting_for(call.about, AgvId{call.what}, agv);
    case PendingCall::Kind::WorksOn:
      return ports_.declarations.set_work(call.about, TransportId{call.what}, agv);
    case PendingCall::Kind::Timer:
      return ports_.timers.set(agv, call.what, call.instant_ns);
    case PendingCall::Kind::Keep:
      return ports_.disks.write(agv);
    case PendingCall::Kind::Nothing:
      return;
  }
}

inline std::int32_t AgvController::take_effect(AgvId agv, const PendingCall& call) {
  AgvState& agv_state = agv_states_[agv.index()];
  if (agv_state.handle.cost == Duration::zero()) [[likely]] {
    carry_out(agv, call);
  } else {
    agv_state.put_off(run_, PendingCall(call));  // a copy, so that a call that is carried out need not be in memory
  }
  return FP_OK;
}

[[gnu::noinline]] void AgvController::AgvState::put_off(RunContext& run, const PendingCall& call) {
  pending.push_back(call);
  run.queue.push(run.now + handle.cost, handle.agv, Event::Kind::CallTakesEffect);
}

void AgvController::call_takes_effect(AgvId agv) {
  auto& pending = agv_states_[agv.index()].pending;
  const PendingCall call = pending.front();
  pending.pop_front();
  carry_out(agv, call);
}

std::int32_t AgvController::act(AgvId agv, fp_call call, std::uint32_t segment, LoadId load) {
  const bool here = segment == FP_HERE && call != FP_CALL_MOVE;
  if (!here && (segment & ~FP_BACKWARD) >= run_.scenario.map->segment_count()) return FP_INVALID;
  if (!ports_.actions.accept(agv, call, segment, load)) return FP_REFUSED;
  return take_effect(
      agv,
      {.kind = PendingCall::Kind::Action, .what = static_cast<std::uint32_t>(call), .segment = segment, .load = load});
}

std::int32_t AgvController::pick_load(AgvId agv, std::uint32_t segment, std::uint32_t order) {
  const LoadId load = run_.world.load_of(TransportId{order});
  if (!load.valid()) return FP_INVALID;
  if (const Load& named = run_.world.load(load); named.carrier != agv && !named.is_open) return FP_INVALID;
  return act(agv, FP_CALL_PICK, segment, load);
}

std::int32_t AgvController::stop(AgvId agv, bool on) {
  return take_effect(agv, {.kind = PendingCall::Kind::Stop, .what = on ? 1U : 0U});
}

void AgvController::apply_stop(AgvId agv, bool on) {
  if (on == run_.status(agv).is_held_by(Halt::Reason::Agent)) return;
  run_.trace(agv, traced::StoppedByAgent{on});
  if (on) {
    ports_.halts.begin(agv, Halt::Reason::Agent);
  } else {
    ports_.halts.end_all(agv, Halt::Reason::Agent);
  }
}

std::uint32_t AgvController::order_on_board(AgvId agv) const {
  const LoadId load = run_.world.carried_load(agv);
  return load.valid() ? run_.world.loads()[load.index()].transport.value : FP_NONE;
}

std::int32_t AgvController::send(AgvId agv, std::string_view bytes, std::uint32_t receiver) {
  const auto slot = ports_.messenger.accept(agv, bytes, receiver);
  if (!slot) return FP_INVALID;
  if (run_.hears_notes() && ports_.declarations.message_sent(agv, ports_.messenger.hash_of(*slot)))
    ports_.messenger.spare(*slot);
  return take_effect(agv, {.kind = PendingCall::Kind::Send, .what = receiver, .message = *slot});
}

std::int32_t AgvController::set_timer(AgvId agv, std::uint32_t number, std::int64_t at_ns) {
  return take_effect(agv, {.kind = PendingCall::Kind::Timer, .what = number, .instant_ns = at_ns});
}

std::int32_t AgvController::declare_safe_mode(AgvId agv, bool on) {
  return take_effect(agv, {.kind = PendingCall::Kind::SafeMode, .what = on ? 1U : 0U});
}

std::int32_t AgvController::declare_waiting(EntityId speaker, std::uint32_t agv, std::uint32_t other) {
  if (!may_speak_for(run_.scenario, speaker, agv) || (other != FP_NONE && other >= run_.agvs.size())) return FP_INVALID;
  return take_effect(speaker, {.kind = PendingCall::Kind::WaitingFor, .what = other, .about = AgvId{agv}});
}

std::int32_t AgvController::works_on(EntityId speaker, std::uint32_t agv, std::uint32_t order) {
  if (!may_speak_for(run_.scenario, speaker, agv)) return FP_INVALID;
  if (order != FP_NONE) {
    const TransportId transport{order};
    if (!run_.world.load_of(transport).valid()) return FP_INVALID;
    if (!run_.orders.is_open(transport) && run_.orders.agv_of(transport).value != agv) return FP_INVALID;
  }
  return take_effect(speaker, {.kind = PendingCall::Kind::WorksOn, .what = order, .about = AgvId{agv}});
}

std::int32_t AgvController::declare_cost(AgvId agv, std::int64_t cost_ns) {
  if (cost_ns < 0 || cost_ns > kDeclaredCostMax_ns) return FP_INVALID;
  agv_states_[agv.index()].handle.cost += Duration{cost_ns};
  return FP_OK;
}

std::int32_t AgvController::keep(AgvId agv, std::uint32_t number, DiskRecord record) {
  if (!ports_.disks.accept(agv, number, std::move(record))) return FP_REFUSED;
  return take_effect(agv, {.kind = PendingCall::Kind::Keep});
}

std::uint64_t AgvController::random(AgvId agv, std::uint32_t purpose, std::uint64_t index) const {
  return word64(philox(random_key_, {static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(index >> 32),
                                     purpose, run_.draw_numbers.of(agv).value}),
                0);
}

}  // namespace fleetproof
