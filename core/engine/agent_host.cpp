#include "core/engine/agent_host.hpp"

#include <algorithm>
#include <utility>

#include "core/base/outside_text.hpp"
#include "core/engine/agv_controller.hpp"

namespace fleetproof {
namespace {

// Of one agent in a run: two million, and ten thousand more for every simulated second. No control software needs so
// many. An agent that sets its timer a nanosecond ahead for ever meets this limit at the same event on every machine.
constexpr std::uint64_t kActivationsPerRun = 2'000'000, kActivationsPerSecond = 10'000;

constexpr std::size_t kLongestMessage = 200;  // characters: an agent may throw any text

bool is_usable(const ToldPlant* plant, const Scenario& scenario) { return plant != nullptr && plant->fits(scenario); }

}  // namespace

AgentHost::AgentHost(RunContext& run, const Ports& ports, const fp_agent_type& type, const char* agent_config,
                     const RunWatch& watch)
    : run_(run),
      ports_(ports),
      own_plant_(is_usable(watch.plant, run.scenario) ? nullptr : std::make_unique<ToldPlant>(run.scenario)),
      briefings_(run.scenario, agent_config, own_plant_ ? *own_plant_ : *watch.plant, watch.share_facts),
      caller_(type, watch),
      activations_max_(kActivationsPerRun +
                       kActivationsPerSecond * static_cast<std::uint64_t>(to_seconds(run.scenario.horizon))),
      slices_(run.agvs.size()) {
  for (std::size_t i = 0; i < slices_.size(); ++i) slices_[i].controller = ports_.controller.handle_of(AgvId{i});
}

AgentHost::~AgentHost() {
  if (!caller_.plays()) close();  // a played run has no agents
}

void AgentHost::close() {
  for (std::size_t i = 0; i < slices_.size(); ++i) destroy(AgvId{i});
  caller_.finish();
}

// ---- activations

void AgentHost::tell(AgvId agv, fp_event event) {
  event.struct_size = sizeof(fp_event);
  event.now_ns = ports_.timers.now_ns(agv);
  Slice& slice = slices_[agv.index()];
  if (slice.away > 0) return;
  if (slice.controller->in_activation() || run_.now < slice.free_at || !slice.waiting_events.empty()) [[unlikely]]
    return keep(agv, slice, event);
  activate(agv, slice, event);
}

[[gnu::noinline]] void AgentHost::keep(AgvId agv, Slice& slice, const fp_event& event) {
  slice.waiting_events.push_back(event);
  if (!slice.controller->in_activation()) wake(agv, slice);
}

[[gnu::noinline]] void AgentHost::wake(AgvId agv, Slice& slice) {
  const SimTime at = std::max(run_.now, slice.free_at);
  if (slice.wakes_at <= at || slice.waiting_events.empty()) return;
  slice.wakes_at = at;
  run_.queue.push(at, agv, Event::Kind::AgentIsFree);
}

void AgentHost::becomes_free(AgvId agv) {
  Slice& slice = slices_[agv.index()];
  if (run_.now != slice.wakes_at) return;  // of an agent that was busy before its computer went down
  slice.wakes_at = SimTime::max();
  if (slice.failed || slice.waiting_events.empty()) return;
  if (run_.now < slice.free_at) return wake(agv, slice);  // frozen since
  fp_event event = slice.waiting_events.front();
  slice.waiting_events.pop_front();
  if (event.kind == FP_EVENT_ORDER && is_over(TransportId{event.order_id})) return wake(agv, slice);  // done meanwhile
  event.now_ns = ports_.timers.now_ns(agv);
  activate(agv, slice, event);
}

void AgentHost::freeze_until(AgvId agv, SimTime until) {
  Slice& slice = slices_[agv.index()];
  slice.free_at = std::max(slice.free_at, until);
  slice.frozen_until = std::max(slice.frozen_until, until);
}

[[gnu::always_inline]] inline void AgentHost::activate(AgvId agv, Slice& slice, const fp_event& event) {
  if (!slice.activations.admit(run_.now, activations_max_)) [[unlikely]]
    return give_up(agv, true, slice.activations.broken_limit());
  const bool starts = event.kind == FP_EVENT_START;
  ++run_.counters.activations;
  ports_.controller.begin_activation(*slice.controller);
  const AgentFailure* failure =
      starts ? start_agent(agv, event) : caller_.tell(agv, run_.now, event, slice.controller, slice.agent);
  if (failure != nullptr) [[unlikely]]
    give_up(agv, failure->hang, failure->message);
  if (ports_.controller.end_activation(*slice.controller)) [[unlikely]]
    settle(agv, slice);
  if (starts && slice.boot > 0) tell_open_orders(agv);
  if (!slice.waiting_events.empty()) [[unlikely]]
    wake(agv, slice);
}

// An activation has taken time or broken a limit.
[[gnu::noinline]] void AgentHost::settle(AgvId agv, Slice& slice) {
  if (const char* limit = slice.controller->broken_limit()) give_up(agv, true, limit);
  slice.free_at = std::max(slice.free_at, run_.now + slice.controller->cost);
}

[[gnu::noinline]] const AgentFailure* AgentHost::start_agent(AgvId agv, const fp_event& event) {
  Slice& slice = slices_[agv.index()];
  if (slice.boot > 0) {
    renew_briefing(agv);
    // An agent whose computer freezes starts later than it was started. Actions that ended by then are over in its
    // briefing: they were none of its own.
    std::erase_if(slice.waiting_events, [](const fp_event& waiting) { return waiting.kind == FP_EVENT_ACTION_DONE; });
  }
  return caller_.start({agv, run_.now, &event, slice.controller, &briefings_.of(agv)}, slice.agent);
}

[[gnu::noinline]] void AgentHost::give_up(AgvId agv, bool hang, std::string_view message) {
  if (!file_failure(agv, hang, message)) return;
  if (hang) {
    run_.trace(agv, traced::AgentHung{});
  } else {
    run_.trace(agv, traced::AgentCrashed{});
  }
}

// False if the agent had failed before.
bool AgentHost::file_failure(AgvId agv, bool hang, std::string_view message) {
  Slice& slice = slices_[agv.index()];
  if (slice.failed) return false;
  slice.failed = true;
  ++slice.away;  // for good
  slice.waiting_events.clear();
  (hang ? hang_ : crash_) = true;
  if (message_.empty()) message_ = "agent of " + run_.setup(agv).name + ": " + printable(message, kLongestMessage);
  return true;
}

void AgentHost::file_failures(Outcome& outcome) const {
  outcome.crash = crash_;
  outcome.hang = hang_;
  outcome.message = message_;
}

// ---- what the agent is told

void AgentHost::start(AgvId agv) {
  fp_event event{};
  event.kind = FP_EVENT_START;
  tell(agv, event);
}

void AgentHost::order_released(AgvId agv, std::uint64_t own_number) {
  const TransportOrder& order = run_.setup(agv).transports[own_number];
  const TransportId transport = run_.transport_of(agv, own_number);
  ++run_.counters.transports_released;
  const LoadId load = run_.world.add_load(transport, agv, order.from, order.to);
  run_.trace(agv, traced::OrderReleased{transport});
  run_.trace_load(load);
  tell_order(agv, transport, order.from, order.to);
}

void AgentHost::tell_order(AgvId agv, TransportId transport, StationId from, StationId to) {
  fp_event event{};
  event.kind = FP_EVENT_ORDER;
  event.order_id = transport.value;
  event.from = from.value;
  event.to = to.value;
  tell(agv, event);
}

// ---- restarts

void AgentHost::goes_away(AgvId agv) {
  Slice& slice = slices_[agv.index()];
  ++slice.away;
  destroy(agv);
  slice.waiting_events.clear();
  slice.free_at = slice.frozen_until;  // nobody thinks any more
  ports_.controller.forget(agv);
}

void AgentHost::comes_back(AgvId agv) {
  Slice& slice = slices_[agv.index()];
  if (--slice.away > 0) return;  // another reason still holds
  ++slice.boot;
  start(agv);
}

// The agent has been started again, perhaps long after its computer was back. The transports that are not done by now
// are handed out again, that of the load on board first, and before all that has arrived since.
[[gnu::noinline]] void AgentHost::tell_open_orders(AgvId agv) {
  auto& waiting = slices_[agv.index()].waiting_events;
  std::erase_if(waiting, [](const fp_event& event) { return event.kind == FP_EVENT_ORDER; });
  const auto arrived = std::exchange(waiting, {});
  const auto loads = run_.world.loads();
  const LoadId on_board = run_.world.carried_load(agv);
  if (on_board.valid()) tell_again(agv, loads[on_board.index()]);
  for (std::size_t i = 0; i < loads.size(); ++i) {
    if (loads[i].carrier == agv && !loads[i].is_over() && LoadId{i} != on_board) tell_again(agv, loads[i]);
  }
  if (!slices_[agv.index()].failed) waiting.insert(waiting.end(), arrived.begin(), arrived.end());
}

bool AgentHost::is_over(TransportId transport) const {
  return run_.world.loads()[run_.world.load_of(transport).index()].is_over();
}

void AgentHost::tell_again(AgvId agv, const Load& load) {
  const TransportOrder& order = run_.setup(agv).transports[run_.own_number(agv, load.transport)];
  const bool at_station = load.holder.kind == Holder::Kind::Station;
  tell_order(agv, load.transport, at_station ? StationId{load.holder.index} : order.from, order.to);
}

void AgentHost::renew_briefing(AgvId agv) {
  const LanesAhead lanes = ports_.actions.lanes(agv);
  briefings_.renew(agv, slices_[agv.index()].boot, run_.status(agv).station,
                   lanes.still_to_drive ? lanes.current : nullptr, lanes.next);
}

void AgentHost::destroy(AgvId agv) {
  Slice& slice = slices_[agv.index()];
  if (slice.agent == nullptr) return;
  void* agent = std::exchange(slice.agent, nullptr);
  if (const AgentFailure* failure = caller_.destroy({.agv = agv, .at = run_.now}, agent))
    file_failure(agv, failure->hang, failure->message);
}

}  // namespace fleetproof
