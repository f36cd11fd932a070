#include "core/engine/agent_host.hpp"

#include <algorithm>
#include <utility>

#include "core/base/outside_text.hpp"
#include "core/engine/agv_controller.hpp"
#include "core/sdk/agent_table.hpp"

namespace fleetproof {
namespace {

// Of one agent in a run: two million, and ten thousand more for every simulated second. No control software needs so
// many. An agent that sets its timer a nanosecond ahead for ever meets this limit at the same event on every machine.
constexpr std::uint64_t kActivationsPerRun = 2'000'000, kActivationsPerSecond = 10'000;

constexpr std::size_t kLongestMessage = 200;  // characters: an agent may throw any text

// Nobody is told that a transport was withdrawn of which it has not been told.
void forget_withdrawal(std::list<fp_event>& events, std::uint32_t order) {
  std::erase_if(events,
                [order](const fp_event& event) { return event.kind == FP_EVENT_WITHDRAWN && event.order_id == order; });
}

bool is_usable(const ToldPlant* plant, const Scenario& scenario) { return plant != nullptr && plant->fits(scenario); }

}  // namespace

AgentHost::AgentHost(RunContext& run, const Ports& ports, const FleetSoftware& software, const RunWatch& watch)
    : run_(run),
      ports_(ports),
      own_plant_(is_usable(watch.plant, run.scenario) ? nullptr : std::make_unique<ToldPlant>(run.scenario)),
      briefings_(run.scenario, software, own_plant_ ? *own_plant_ : *watch.plant, watch.share_facts),
      caller_(watch),
      activations_max_(kActivationsPerRun +
                       kActivationsPerSecond * static_cast<std::uint64_t>(to_seconds(run.scenario.horizon))),
      agv_states_(run.scenario.participant_count()) {
  if (watch.note != nullptr) watch.note->fleet = static_cast<std::uint32_t>(run.agvs.size());
  for (std::size_t i = 0; i < agv_states_.size(); ++i) {
    agv_states_[i].type = software.of(run.scenario, EntityId{i}).type;
    agv_states_[i].controller = ports_.controller.handle_of(EntityId{i});
    agv_states_[i].controller->plant = own_plant_ ? own_plant_.get() : watch.plant;
  }
}

AgentHost::~AgentHost() {
  if (!caller_.plays()) close();  // a played run has no agents
}

void AgentHost::close() {
  for (std::size_t i = 0; i < agv_states_.size(); ++i) destroy(AgvId{i});
  if (!std::exchange(is_over_, true)) tell_end_of_run();
  caller_.finish();
}

// Each program with data of its own, once; a played run knows no programs.
void AgentHost::tell_end_of_run() {
  std::vector<const fp_bridge*> told;
  for (std::size_t i = 0; i < agv_states_.size(); ++i) {
    const EntityId first{i};
    if (caller_.plays()) {
      if (!caller_.tape_ends_run_for(first)) continue;
    } else {
      const fp_bridge* bridge = bridge_of(*agv_states_[i].type);
      if (bridge == nullptr || bridge->run_ends == nullptr || std::ranges::find(told, bridge) != told.end()) continue;
      told.push_back(bridge);
    }
    AgentCall end{*agv_states_[i].type, first, run_.now};
    end.is_run_end = true;
    if (const AgentFailure* failure = caller_.end_run(end)) file_failure(first, failure->hang, failure->message);
  }
}

// ---- activations

void AgentHost::tell(AgvId agv, fp_event event) {
  event.struct_size = sizeof(fp_event);
  event.now_ns = ports_.timers.now_ns(agv);
  AgvState& agv_state = agv_states_[agv.index()];
  if (agv_state.away > 0) return;
  if (agv_state.controller->in_activation() || run_.now < agv_state.free_at || !agv_state.waiting_events.empty())
      [[unlikely]]
    return keep(agv, agv_state, event);
  activate(agv, agv_state, event);
}

[[gnu::noinline]] void AgentHost::keep(AgvId agv, AgvState& agv_state, const fp_event& event) {
  agv_state.waiting_events.push_back(event);
  if (!agv_state.controller->in_activation()) wake(agv, agv_state);
}

[[gnu::noinline]] void AgentHost::wake(AgvId agv, AgvState& agv_state) {
  const SimTime at = std::max(run_.now, agv_state.free_at);
  if (agv_state.wakes_at <= at || agv_state.waiting_events.empty()) return;
  agv_state.wakes_at = at;
  run_.queue.push(at, agv, Event::Kind::AgentIsFree);
}

void AgentHost::becomes_free(AgvId agv) {
  AgvState& agv_state = agv_states_[agv.index()];
  if (run_.now != agv_state.wakes_at) return;  // of an agent that was busy before its computer went down
  agv_state.wakes_at = SimTime::max();
  if (agv_state.failed || agv_state.waiting_events.empty()) return;
  if (run_.now < agv_state.free_at) return wake(agv, agv_state);  // frozen since
  fp_event event = agv_state.waiting_events.front();
  agv_state.waiting_events.pop_front();
  if (event.kind == FP_EVENT_ORDER && run_.is_over(TransportId{event.order_id})) {  // done or withdrawn meanwhile
    forget_withdrawal(agv_state.waiting_events, event.order_id);
    return wake(agv, agv_state);
  }
  event.now_ns = ports_.timers.now_ns(agv);
  activate(agv, agv_state, event);
}

void AgentHost::freeze_until(AgvId agv, SimTime until) {
  AgvState& agv_state = agv_states_[agv.index()];
  agv_state.free_at = std::max(agv_state.free_at, until);
  agv_state.frozen_until = std::max(agv_state.frozen_until, until);
}

[[gnu::always_inline]] inline void AgentHost::activate(AgvId agv, AgvState& agv_state, const fp_event& event) {
  if (!agv_state.activations.admit(run_.now, activations_max_)) [[unlikely]]
    return give_up(agv, true, agv_state.activations.broken_limit());
  const bool starts = event.kind == FP_EVENT_START;
  ++run_.counters.activations;
  ports_.controller.begin_activation(*agv_state.controller);
  const AgentFailure* failure =
      starts ? start_agent(agv, event)
             : caller_.tell(*agv_state.type, agv, run_.now, event, agv_state.controller, agv_state.agent);
  if (failure != nullptr) [[unlikely]]
    give_up(agv, failure->hang, failure->message);
  if (ports_.controller.end_activation(*agv_state.controller)) [[unlikely]]
    settle(agv, agv_state);
  if (starts && agv_state.boot > 0) tell_open_orders(agv);
  if (!agv_state.waiting_events.empty()) [[unlikely]]
    wake(agv, agv_state);
}

// An activation has taken time, broken a limit, or filed a failure.
[[gnu::noinline]] void AgentHost::settle(AgvId agv, AgvState& agv_state) {
  if (const auto& failure = agv_state.controller->failure) {
    // A tape does not have the calls that came after it.
    run_.counters.agent_calls -= agv_state.controller->calls + agv_state.controller->services - failure->calls;
    give_up(agv, failure->hang, failure->message);
  }
  if (const char* limit = agv_state.controller->broken_limit()) give_up(agv, true, limit);
  agv_state.free_at = std::max(agv_state.free_at, run_.now + agv_state.controller->cost);
}

[[gnu::noinline]] const AgentFailure* AgentHost::start_agent(AgvId agv, const fp_event& event) {
  AgvState& agv_state = agv_states_[agv.index()];
  if (agv_state.boot > 0) {
    renew_briefing(agv);
    // An agent whose computer freezes starts later than it was started. Actions that ended by then are over in its
    // briefing: they were none of its own.
    std::erase_if(agv_state.waiting_events,
                  [](const fp_event& waiting) { return waiting.kind == FP_EVENT_ACTION_DONE; });
  }
  return caller_.start({*agv_state.type, agv, run_.now, &event, agv_state.controller, &briefings_.of(agv)},
                       agv_state.agent);
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
  AgvState& agv_state = agv_states_[agv.index()];
  if (agv_state.failed) return false;
  agv_state.failed = true;
  ++agv_state.away;  // for good
  agv_state.waiting_events.clear();
  (hang ? hang_ : crash_) = true;
  if (message_.empty())
    message_ = "agent of " + run_.scenario.name_of(agv) + ": " + printable(message, kLongestMessage);
  return true;
}

void AgentHost::file_failures(Outcome& outcome) const {
  outcome.crash = crash_;
  outcome.hang = hang_;
  outcome.message = message_;
  outcome.counters.processor_changes = caller_.processor_changes();
}

// ---- what the agent is told

void AgentHost::start(AgvId agv) {
  fp_event event{};
  event.kind = FP_EVENT_START;
  tell(agv, event);
}

void AgentHost::order_released(TransportId transport) {
  const TransportOrder& order = run_.orders.order(transport);
  ++run_.counters.transports_released;
  run_.add_load(transport);
  const auto [first, end] = run_.audience_of(transport);
  for (std::uint32_t id = first; id < end; ++id) tell_order(EntityId{id}, transport, order.from, order.to);
}

void AgentHost::order_withdrawn(TransportId transport) {
  const LoadId id = run_.world.load_of(transport);
  const Load load = run_.world.load(id);
  if (load.is_over()) return;
  run_.trace(load.carrier, traced::OrderWithdrawn{transport});
  if (!load.was_taken_up) {
    ++run_.counters.transports_withdrawn;
    run_.move_load(id, {Holder::Kind::Withdrawn, 0});
  }
  fp_event event{};
  event.kind = FP_EVENT_WITHDRAWN;
  event.order_id = transport.value;
  const auto [first, end] = run_.audience_of(transport);
  for (std::uint32_t told = first; told < end; ++told) tell(EntityId{told}, event);
}

void AgentHost::tell_order(AgvId agv, TransportId transport, StationId from, StationId to) {
  fp_event event{};
  event.kind = FP_EVENT_ORDER;
  event.order_id = transport.value;
  event.from = from.value;
  event.to = to.value;
  tell(agv, event);
}

std::optional<Denial> AgentHost::why_not_told(AgvId agv, const std::string& word) {
  const AgvState& agv_state = agv_states_[agv.index()];
  if (agv_state.agent == nullptr) return Denial::AgentAway;  // frozen since before its start
  bool knows = false;
  const AgentCall question{*agv_state.type, agv, run_.now, nullptr, nullptr, nullptr, {word.c_str(), &knows}};
  if (const AgentFailure* failure = caller_.ask(question, agv_state.agent)) {
    give_up(agv, failure->hang, failure->message);
    return Denial::AgentAway;
  }
  return knows ? std::nullopt : std::optional(Denial::UnknownWord);
}

void AgentHost::tell_fault(AgvId agv, const Fault& fault) {
  fp_event event{};
  event.kind = FP_EVENT_FAULT;
  event.fault_word = fault.word.c_str();
  event.fault_number = fault.number;
  event.fault_length_ns = fault.lasts.count();
  tell(agv, event);
}

// ---- restarts

void AgentHost::goes_away(AgvId agv) {
  AgvState& agv_state = agv_states_[agv.index()];
  ++agv_state.away;
  destroy(agv);
  agv_state.waiting_events.clear();
  agv_state.free_at = agv_state.frozen_until;  // nobody thinks any more
  ports_.controller.forget(agv);
}

void AgentHost::comes_back(AgvId agv) {
  AgvState& agv_state = agv_states_[agv.index()];
  if (--agv_state.away > 0) return;  // another reason still holds
  ++agv_state.boot;
  start(agv);
}

// The agent has been started again, perhaps long after its computer was back. The transports that are not done by now
// are handed out again, that of the load on board first, and before all that has arrived since.
[[gnu::noinline]] void AgentHost::tell_open_orders(AgvId agv) {
  auto& waiting = agv_states_[agv.index()].waiting_events;
  std::erase_if(waiting, [&](const fp_event& event) {
    return event.kind == FP_EVENT_ORDER ||
           (event.kind == FP_EVENT_WITHDRAWN && run_.is_over(TransportId{event.order_id}));
  });
  const auto arrived = std::exchange(waiting, {});
  const auto loads = run_.world.loads();
  const LoadId on_board = run_.scenario.is_agv(agv) ? run_.world.carried_load(agv) : LoadId{};
  const auto is_told = [&](LoadId load) {
    return run_.audience_of(loads[load.index()].transport).has(agv) && !loads[load.index()].is_over();
  };
  if (on_board.valid() && is_told(on_board)) tell_again(agv, loads[on_board.index()]);
  for (std::size_t i = 0; i < loads.size(); ++i) {
    if (LoadId{i} != on_board && is_told(LoadId{i})) tell_again(agv, loads[i]);
  }
  if (!agv_states_[agv.index()].failed) waiting.insert(waiting.end(), arrived.begin(), arrived.end());
}

void AgentHost::tell_again(AgvId agv, const Load& load) {
  const TransportOrder& order = run_.orders.order(load.transport);
  const bool at_station = load.holder.kind == Holder::Kind::Station;
  tell_order(agv, load.transport, at_station ? StationId{load.holder.index} : order.from, order.to);
}

void AgentHost::renew_briefing(AgvId agv) {
  if (run_.scenario.is_computer(agv)) return briefings_.renew(agv, agv_states_[agv.index()].boot);
  const LanesAhead lanes = ports_.actions.lanes(agv);
  briefings_.renew(agv, agv_states_[agv.index()].boot, run_.status(agv).station,
                   lanes.still_to_drive ? lanes.current : nullptr, lanes.next);
}

void AgentHost::destroy(AgvId agv) {
  AgvState& agv_state = agv_states_[agv.index()];
  if (agv_state.agent == nullptr) return;
  void* agent = std::exchange(agv_state.agent, nullptr);
  if (const AgentFailure* failure = caller_.destroy({*agv_state.type, agv, run_.now}, agent))
    file_failure(agv, failure->hang, failure->message);
}

}  // namespace fleetproof
