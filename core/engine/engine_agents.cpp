// Activations: when an agent is called, what its thinking costs, and what happens when it crashes or hangs.
#include <exception>

#include "core/base/error.hpp"
#include "core/base/random.hpp"
#include "core/engine/engine.hpp"

namespace fleetproof {
namespace {

constexpr std::uint32_t kCallsMax = 10'000;        // in one activation
constexpr std::uint32_t kActivationsMax = 10'000;  // of one agent without time advancing
// Of one agent in a run: two million, and ten thousand more for every simulated second. Far beyond what any control
// software needs, and counted, so that an agent that sets its timer a nanosecond ahead for ever is found out at the
// same event on every machine.
constexpr std::uint64_t kActivationsPerRun = 2'000'000, kActivationsPerSecond = 10'000;

// One line that any page and any JSON can hold: an agent may throw whatever it likes.
std::string printable(std::string_view text) {
  constexpr std::size_t kLongestMessage = 200;
  std::string line;
  for (const char c : text.substr(0, kLongestMessage)) line += c >= 0x20 && c < 0x7f ? c : '?';
  return line + (text.size() > kLongestMessage ? "..." : "");
}

}  // namespace

void Engine::tell(Agv& agv, fp_event event) {
  event.struct_size = sizeof(fp_event);
  if (agv.agent_failed || agv.agent_away > 0) return;
  if (agv.in_activation || now_ < agv.free_at || !agv.waiting_events.empty()) {
    agv.waiting_events.push_back(event);
    if (!agv.in_activation) wake(agv);
    return;
  }
  activate(agv, event);
}

void Engine::wake(Agv& agv) {
  if (agv.wake_scheduled || agv.waiting_events.empty()) return;
  agv.wake_scheduled = true;
  queue_.push(std::max(now_, agv.free_at), agv.id, Event::Kind::AgentIsFree);
}

void Engine::agent_is_free(Agv& agv) {
  agv.wake_scheduled = false;
  if (agv.agent_failed || agv.waiting_events.empty()) return;
  if (now_ < agv.free_at) return wake(agv);  // frozen since
  const fp_event event = agv.waiting_events.front();
  agv.waiting_events.pop_front();
  activate(agv, event);
}

void Engine::activate(Agv& agv, const fp_event& what) {
  agv.activations_at_instant = agv.last_activation == now_ ? agv.activations_at_instant + 1 : 1;
  agv.last_activation = now_;
  if (agv.activations_at_instant > kActivationsMax)
    return give_up(agv, true, "10 000 activations without time advancing");
  const auto run_max =
      kActivationsPerRun + kActivationsPerSecond * static_cast<std::uint64_t>(to_seconds(scenario_.horizon));
  if (++agv.activations > run_max) return give_up(agv, true, "woke up more often than any control software needs");
  ++outcome_.counters.activations;
  agv.in_activation = true;
  agv.calls = 0;
  agv.cost = Duration::zero();
  fp_event event = what;
  event.now_ns = agent_now_ns(agv);
  try {
    if (event.kind == FP_EVENT_START) {
      if (agv.boot > 0) renew_briefing(agv);
      agv.agent = agent_type_.create(&kHost, &controllers_[agv.id.index()], &briefings_.of(agv.id));
      if (agv.agent == nullptr) throw std::runtime_error("create() returned null");
    }
    agent_type_.on_event(agv.agent, &event);
  } catch (const InvariantViolation&) {
    throw;  // ours, not the agent's
  } catch (const std::exception& error) {
    give_up(agv, false, error.what());
  } catch (...) {
    give_up(agv, false, "unknown exception");
  }
  drop_message_in_hand(agv);
  agv.in_activation = false;
  outcome_.counters.agent_calls += agv.calls;
  if (agv.calls > kCallsMax) give_up(agv, true, "10 000 controller calls in one activation");
  agv.free_at = std::max(agv.free_at, now_ + agv.cost);
  agv.cost = Duration::zero();
  wake(agv);
}

void Engine::give_up(Agv& agv, bool hang, std::string_view message) {
  if (agv.agent_failed) return;
  agv.agent_failed = true;
  agv.waiting_events.clear();
  (hang ? outcome_.hang : outcome_.crash) = true;
  if (outcome_.message.empty()) {
    outcome_.message = "agent of " + scenario_.agvs[agv.id.index()].name + ": " + printable(message);
  }
  trace(agv.id, hang ? TraceKind::AgentHung : TraceKind::AgentCrashed);
}

bool Engine::admit_call(Agv& agv) {
  // A call from outside an activation (another thread, a stored pointer) has no instant at which it could act.
  if (!agv.in_activation || ++agv.calls > kCallsMax) return false;
  agv.cost += seconds(scenario_.agent_clock.call_cost_s);
  return true;
}

std::uint64_t Engine::random(const Agv& agv, std::uint32_t purpose, std::uint64_t index) const {
  return word64(philox(agent_key_, {static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(index >> 32), purpose,
                                    agv.id.value}),
                0);
}

void Engine::take_effect_later(Agv& agv, PendingCall call) {
  agv.pending_calls.push_back(call);
  queue_.push(now_ + agv.cost, agv.id, Event::Kind::CallTakesEffect);
}

void Engine::call_takes_effect(Agv& agv) {
  const PendingCall call = agv.pending_calls.front();
  agv.pending_calls.pop_front();
  switch (call.kind) {
    case PendingCall::Kind::Action:
      begin_action(agv, static_cast<fp_call>(call.what), call.segment);
      break;
    case PendingCall::Kind::Send:
      transmit(agv, call.message, call.what);
      break;
    case PendingCall::Kind::SafeMode:
      apply_safe_mode(agv, call.what != 0, now_);
      break;
    case PendingCall::Kind::WaitingFor:
      trace(agv.id, TraceKind::WaitingFor, call.what);
      break;
    case PendingCall::Kind::Timer:
      apply_timer(agv, call.what, call.instant_ns);
      break;
    case PendingCall::Kind::Nothing:
      break;
  }
}

void Engine::order_released(Agv& agv, std::uint64_t transport) {
  const TransportOrder& order = scenario_.agvs[agv.id.index()].transports[transport];
  const TransportId id{static_cast<std::uint32_t>(first_transport_[agv.id.index()] + transport)};
  ++outcome_.counters.transports_released;
  const LoadId load = world_.add_load(id, agv.id, order.from, order.to);
  trace(agv.id, TraceKind::OrderReleased, id.value);
  trace_load(load);
  tell_order(agv, id, order);
}

void Engine::tell_order(Agv& agv, TransportId id, const TransportOrder& order) {
  fp_event event{};
  event.kind = FP_EVENT_ORDER;
  event.order_id = id.value;
  event.from = order.from.value;
  event.to = order.to.value;
  tell(agv, event);
}

// The computer goes down: what the agent knew, was told and was about to do is lost. Orders already given to the AGV
// are carried out.
void Engine::agent_goes_away(Agv& agv) {
  ++agv.agent_away;
  destroy_agent(agv);
  agv.waiting_events.clear();
  agv.timers.clear();
  for (std::size_t i = agv.inbox_read; i < agv.inbox.size(); ++i) messages_.release(agv.inbox[i]);
  agv.inbox.clear();
  agv.inbox_read = 0;
  for (PendingCall& call : agv.pending_calls) {
    if (call.kind == PendingCall::Kind::Send) messages_.release_unsent(call.message);
    if (call.kind == PendingCall::Kind::Action) agv.committed = agv.acting;
    call.kind = PendingCall::Kind::Nothing;
  }
  apply_safe_mode(agv, false, now_);
  trace(agv.id, TraceKind::WaitingFor, FP_NONE);
}

void Engine::agent_comes_back(Agv& agv) {
  if (--agv.agent_away > 0) return;  // not for that reason alone
  ++agv.boot;
  fp_event start{};
  start.kind = FP_EVENT_START;
  tell(agv, start);
  // Who hands out the transports asks again for those that are not done.
  for (std::size_t i = 0; i < world_.loads().size(); ++i) {
    const Load& load = world_.loads()[i];
    if (load.carrier != agv.id || load.is_over()) continue;
    TransportOrder order =
        scenario_.agvs[agv.id.index()].transports[load.transport.value - first_transport_[agv.id.index()]];
    if (load.holder.kind == Holder::Kind::Station) order.from = StationId{load.holder.index};
    tell_order(agv, load.transport, order);
  }
}

void Engine::renew_briefing(const Agv& agv) {
  const bool driving = agv.activity && agv.activity->kind == ActivityKind::Drive;
  const Lane* lane = agv.acting && (driving || agv.plan.drive_due) ? agv.plan.lane : nullptr;
  briefings_.renew(agv.id, agv.boot, agv.station, lane, agv.next ? agv.next->lane : nullptr);
}

void Engine::destroy_agent(Agv& agv) {
  if (agv.agent == nullptr) return;
  try {
    agent_type_.destroy(agv.agent);
  } catch (...) {  // its verdict stands, and a destructor has nobody to tell
  }
  agv.agent = nullptr;
}

// Late, and wrong by another error every tenth of a second.
Pose Engine::perceived_pose(const Agv& agv) const {
  constexpr std::int64_t kErrorLasts_ns = 100'000'000;
  const SensingSetup& sensing = scenario_.agvs[agv.id.index()].sensing;
  const SimTime seen = std::max(kStart, now_ - seconds(sensing.position_late_s));
  const auto past = std::ranges::find_if(agv.past, [&](const Piece& piece) { return seen < piece.end; });
  Pose pose = past != agv.past.end() ? past->pose_at(seen) : world_.pose_of(agv.id, seen);
  if (sensing.position_error_m == 0.0) return pose;
  const auto slot = static_cast<std::uint64_t>(to_ns(now_) / kErrorLasts_ns);
  const Block block = philox(motion_key_, {static_cast<std::uint32_t>(slot), static_cast<std::uint32_t>(slot >> 32),
                                           static_cast<std::uint32_t>(MotionTopic::Position), agv.id.value});
  const auto error_m = [&](std::size_t half) {
    return sensing.position_error_m * (2.0 * unit_interval(word64(block, half)) - 1.0);
  };
  pose.position_m += Vec2{error_m(0), error_m(1)};
  return pose;
}

std::int32_t Engine::set_timer(Agv& agv, std::uint32_t number, std::int64_t at) {
  if (takes_effect_now(agv)) {
    apply_timer(agv, number, at);
  } else {
    take_effect_later(agv, {.kind = PendingCall::Kind::Timer, .what = number, .instant_ns = at});
  }
  return FP_OK;
}

void Engine::apply_timer(Agv& agv, std::uint32_t number, std::int64_t at) {
  auto timer = std::ranges::find(agv.timers, number, &Timer::number);
  if (timer == agv.timers.end()) timer = agv.timers.insert(timer, {number, 0});
  timer->stamp = at < 0 ? 0 : ++agv.timer_stamp;
  if (at >= 0)
    queue_.push(std::max(now_, agv.clock.when_it_shows(at)), agv.id, Event::Kind::TimerGoesOff, number, timer->stamp);
}

void Engine::timer_goes_off(Agv& agv, std::uint32_t number, std::uint64_t stamp) {
  const auto timer = std::ranges::find(agv.timers, number, &Timer::number);
  if (timer == agv.timers.end() || timer->stamp != stamp) return;
  timer->stamp = 0;
  trace(agv.id, TraceKind::TimerWentOff, number);
  fp_event event{};
  event.kind = FP_EVENT_TIMER;
  event.timer = number;
  tell(agv, event);
}

std::int32_t Engine::declare_safe_mode(Agv& agv, bool on) {
  if (takes_effect_now(agv)) {
    apply_safe_mode(agv, on, now_);
  } else {
    take_effect_later(agv, {.kind = PendingCall::Kind::SafeMode, .what = on ? 1U : 0U});
  }
  return FP_OK;
}

void Engine::apply_safe_mode(Agv& agv, bool on, SimTime at) {
  if (on == agv.safe_since.has_value()) return;
  if (on) {
    agv.safe_since = at;
  } else {
    agv.safe_mode_ns += static_cast<std::uint64_t>((at - *agv.safe_since).count());
    agv.safe_since.reset();
  }
  trace(agv.id, TraceKind::SafeMode, on ? 1 : 0);
}

std::int32_t Engine::declare_waiting(Agv& agv, std::uint32_t for_whom) {
  if (for_whom != FP_NONE && for_whom >= agvs_.size()) return FP_INVALID;
  if (takes_effect_now(agv)) {
    trace(agv.id, TraceKind::WaitingFor, for_whom);
  } else {
    take_effect_later(agv, {.kind = PendingCall::Kind::WaitingFor, .what = for_whom});
  }
  return FP_OK;
}

}  // namespace fleetproof
