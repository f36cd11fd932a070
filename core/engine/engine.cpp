#include "core/engine/engine.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/base/error.hpp"
#include "core/outcome/work_and_progress.hpp"

namespace fleetproof {

// A part may get another one that has not been constructed yet: it keeps the address and calls nothing.
Parts::Parts(RunContext& run, const FleetSoftware& software, const RunWatch& watch)
    : battery(run, {HaltsPort(halts), operator_actions}),
      contacts(run, {ActionsPort(actions), operator_actions}),
      sensor(run),
      scanner(run, {contacts, HaltsPort(halts), operator_actions}),
      messenger(run, AgentHostPort(agents)),
      activities(run, {BatteryPort(battery), contacts, faults, MessengerPort(messenger), PositionSensorPort(sensor)}),
      drives(run, {ActivitiesPort(activities), scanner}),
      actions(run, {ActivitiesPort(activities), AgentHostPort(agents), BatteryPort(battery), drives}),
      halts(run, ActionsPort(actions)),
      disks(run),
      faults(run, {ActionsPort(actions), AgentHostPort(agents), contacts, disks, HaltsPort(halts)}),
      operator_actions(run, {ActionsPort(actions), AgentHostPort(agents), BatteryPort(battery), contacts, faults,
                             HaltsPort(halts), MessengerPort(messenger), PositionSensorPort(sensor), scanner}),
      timers(run, AgentHostPort(agents)),
      declarations(run),
      controller(run, {ActionsPort(actions), BatteryPort(battery), declarations, disks, HaltsPort(halts),
                       MessengerPort(messenger), PositionSensorPort(sensor), TimersPort(timers)}),
      agents(run, {ActionsPort(actions), controller, TimersPort(timers)}, software, watch) {}

Engine::Engine(const Scenario& scenario, const FleetSoftware& software, std::span<const std::unique_ptr<Law>> laws,
               TraceSink* sink, const RunWatch& watch)
    : laws_(laws), abandon_(watch.abandon), run_(scenario, laws, sink), parts_(run_, software, watch) {}

// Everything that each event passes through is inlined into this loop.
[[gnu::flatten]] void Engine::run() {
  start();
  const SimTime end = kStart + run_.scenario.horizon;
  Event event;
  while (true) {
    // Arrivals and timers are most events: they are taken from the queue without a copy into an Event. An event at the
    // end of the run still takes place.
    if (run_.queue.arrival_comes_first()) {
      const EventQueue::Arrival& first = run_.queue.first_arrival();
      if (first.at > end) break;
      goes_on_until(first.at);
      const AgvId receiver = first.receiver();
      const std::uint32_t payload = first.payload;
      run_.queue.drop_arrival();
      parts_.messenger.arrives(receiver, payload);
    } else if (run_.queue.timer_comes_first()) {
      const EventQueue::Timer timer = run_.queue.first_timer();
      if (timer.at > end) break;
      goes_on_until(timer.at);
      run_.queue.drop_timer();
      parts_.timers.goes_off(timer.agv, timer.number, timer.stamp);
    } else {
      if (!run_.queue.pop_filed_until(end, event)) break;
      goes_on_until(event.at);
      handle(event);
    }
  }
  // No event is left before the end. Times that are still open are counted up to the end, before the laws get the rest.
  run_.now = end;
  parts_.declarations.settle_accounts();
  parts_.messenger.settle_accounts();
  parts_.battery.settle_accounts();
  run_.writer.hand_over();
  run_.world.finish(end);
}

inline void Engine::goes_on_until(SimTime at) {
  if (abandon_ != nullptr && abandon_->load(std::memory_order_relaxed)) throw RunAbandoned();
  ensure(at >= run_.now, "time goes forward");
  run_.now = at;
}

[[gnu::noinline]] void Engine::start() {
  for (std::size_t i = 0; i < run_.agvs.size(); ++i) {
    const AgvId agv{i};
    run_.queue.push(kStart, agv, Event::Kind::Start);
    announce_orders(agv, run_.setup(agv).transports);
    parts_.contacts.predict(agv);
    parts_.battery.predict_empty(agv);
  }
  for (std::size_t i = 0; i < run_.scenario.computers.size(); ++i)
    run_.queue.push(kStart, EntityId{run_.scenario.first_computer().index() + i}, Event::Kind::Start);
  announce_orders({}, run_.scenario.open_orders);
  // Faults and the operator concern the whole fleet and come last: this order is part of the digest.
  parts_.faults.schedule();
  if (run_.scenario.operator_help.on) run_.queue.push(kStart, EntityId{}, Event::Kind::OperatorLooks);
}

// Of one AGV; of an invalid one, the open ones. Those come after all else of their instant.
void Engine::announce_orders(AgvId agv, const std::vector<TransportOrder>& orders) {
  for (std::size_t i = 0; i < orders.size(); ++i) {
    const std::uint64_t transport = run_.orders.at(agv, i).value;
    run_.queue.push(kStart + orders[i].release, agv, Event::Kind::OrderReleased, transport);
    if (orders[i].withdrawn < run_.scenario.horizon)
      run_.queue.push(kStart + orders[i].withdrawn, agv, Event::Kind::OrderWithdrawn, transport);
  }
}

[[gnu::noinline]] void Engine::handle(const Event& event) {
  const EntityId id = event.entity;
  switch (event.kind) {
    case Event::Kind::Start:
      return parts_.agents.start(id);
    case Event::Kind::OrderReleased:
      return parts_.agents.order_released(TransportId{static_cast<std::uint32_t>(event.payload)});
    case Event::Kind::OrderWithdrawn:
      return parts_.agents.order_withdrawn(TransportId{static_cast<std::uint32_t>(event.payload)});
    case Event::Kind::ActivityEnds:
      if (parts_.activities.is_current(id, event.stamp)) parts_.actions.activity_ends(id);
      return;
    case Event::Kind::CallTakesEffect:
      return parts_.controller.call_takes_effect(id);
    case Event::Kind::MessageArrives:
      return parts_.messenger.arrives(id, event.payload);
    case Event::Kind::TimerGoesOff:
      return parts_.timers.goes_off(id, static_cast<std::uint32_t>(event.payload), event.stamp);
    case Event::Kind::AgentIsFree:
      return parts_.agents.becomes_free(id);
    case Event::Kind::Contact:
      return parts_.contacts.bodies_touch(event.payload);
    case Event::Kind::BatteryEmpty:
      return parts_.battery.runs_empty(id, event.stamp);
    case Event::Kind::FaultStrikes:
      return parts_.faults.strikes(id, event.payload);
    case Event::Kind::FaultOver:
      return parts_.faults.ends(id, event.payload);
    case Event::Kind::BodyAppears:
      return run_.world.body(id).is_agv ? parts_.operator_actions.look_for_place(id)
                                        : parts_.faults.obstacle_appears(id);
    case Event::Kind::BodyLeaves:
      return parts_.faults.body_leaves(id);
    case Event::Kind::ScannerLooks:
      return parts_.scanner.looks(id, event.stamp);
    case Event::Kind::OperatorComes:
      return parts_.operator_actions.comes(id, static_cast<Assist>(event.payload), event.stamp);
    case Event::Kind::OperatorLooks:
      return parts_.operator_actions.looks();
  }
}

// Transports are open, and no work has begun or ended for a long time, although no fault holds an AGV, and no AGV works
// or charges.
bool Engine::is_stuck() const {
  const bool excused = std::ranges::any_of(run_.agvs, [](const AgvStatus& agv) {
    return agv.is_held_by(Halt::Reason::Breakdown) || agv.is_held_by(Halt::Reason::ProtectiveStop) ||
           (agv.activity && keeps_busy(agv.activity->kind));
  });
  return run_.transports_are_open() && !excused && run_.now - run_.last_progress >= run_.scenario.stuck_after;
}

Outcome Engine::finish() {
  Outcome outcome;
  Counters& counters = outcome.counters = run_.counters;
  counters.under_way = counters.receptions + counters.duplicates - counters.receptions_lost - counters.received;
  counters.events = run_.writer.digest().record_count();
  outcome.simulated_ns = static_cast<std::uint64_t>(run_.scenario.horizon.count());
  outcome.agv_count = static_cast<std::uint32_t>(run_.agvs.size());
  outcome.stuck = is_stuck();
  file_findings(outcome);
  outcome.contact = outcome.contact || counters.contacts > 0;
  outcome.digest = run_.writer.digest().value();
  outcome.running_digests = run_.writer.digest().running();
  parts_.agents.close();  // an agent may fail even now
  parts_.agents.file_failures(outcome);
  return outcome;
}

// The first law is the judge of violations; the incidents and the coverage of all laws are filed.
void Engine::file_findings(Outcome& outcome) const {
  std::vector<Incident> incidents;
  std::vector<ProbeCount> probes = parts_.declarations.probes().counts();
  outcome.counters.probes_left_out = parts_.declarations.probes().left_out();
  for (const auto& law : laws_) {
    LawResults findings = law->findings();
    std::ranges::move(findings.incidents, std::back_inserter(incidents));
    std::ranges::move(findings.met, std::back_inserter(probes));
    if (law != laws_.front()) continue;
    file_violations(outcome, std::move(findings.violations));
    if (findings.min_clearance_m) {
      const auto smallest_um = static_cast<std::int64_t>(std::floor(*findings.min_clearance_m * 1e6));
      outcome.min_clearance_um = std::min(outcome.min_clearance_um.value_or(smallest_um), smallest_um);
    }
    outcome.counters.distance_evaluations = findings.distance_evaluations;
    outcome.counters.perimeter_checks = findings.perimeter_checks;
  }
  file_incidents(outcome, std::move(incidents));
  file_probes(outcome, std::move(probes));
}

}  // namespace fleetproof
