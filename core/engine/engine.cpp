#include "core/engine/engine.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/base/error.hpp"
#include "core/base/random.hpp"

namespace fleetproof {
namespace {

// Reception needs a range test only where the floor is larger than the range.
bool covers_floor(const RadioSetup& radio, const LogicalMap& map) {
  Box box;
  for (const Station& station : map.layout().stations) box.add(station.position_m);
  for (const Segment& segment : map.layout().segments) {
    for (const Vec2& point : segment.control_points_m) box.add(point);
  }
  return radio.range_m > (box.high_m - box.low_m).norm();
}

}  // namespace

Engine::Engine(const Scenario& scenario, const fp_agent_type& agent, std::span<const std::unique_ptr<Law>> laws,
               TraceSink* sink, const char* agent_config)
    : scenario_(scenario),
      agent_type_(agent),
      laws_(laws),
      sink_(sink),
      briefings_(scenario, agent_config),
      radio_(scenario.radio, scenario.seed_of(Stream::Radio)),
      channel_(scenario.radio, scenario.seed_of(Stream::Radio)),
      unlimited_range_(covers_floor(scenario.radio, *scenario.map)),
      agent_key_(stream_key(scenario.seed_of(Stream::Agent), Stream::Agent)),
      motion_key_(stream_key(scenario.seed_of(Stream::Motion), Stream::Motion)),
      world_(scenario, laws),
      agvs_(scenario.agvs.size()),
      controllers_(scenario.agvs.size()) {
  for (const auto& law : laws) {
    const TraceKinds kinds = law->reads();
    if (!kinds.empty()) readers_.emplace_back(law.get(), kinds);
    read_by_laws_ = read_by_laws_ | kinds;
  }
  std::uint64_t transports = 0;
  for (std::size_t i = 0; i < agvs_.size(); ++i) {
    agvs_[i].id = AgvId{i};
    agvs_[i].station = scenario.agvs[i].start;
    agvs_[i].battery = scenario.agvs[i].battery;
    agvs_[i].clock = AgentClock(scenario.agvs[i].sensing);
    controllers_[i] = {this, AgvId{i}};
    first_transport_.push_back(transports);
    transports += scenario.agvs[i].transports.size();
  }
}

Engine::~Engine() {
  for (Agv& agv : agvs_) destroy_agent(agv);
}

void Engine::run() {
  start();
  const SimTime end = kStart + scenario_.horizon;
  while (!queue_.empty() && queue_.next_at() <= end) {
    const Event event = queue_.pop();
    ensure(event.at >= now_, "time goes forward");
    now_ = event.at;
    handle(event);
  }
  now_ = end;
  for (Agv& agv : agvs_) {
    apply_safe_mode(agv, false, end);
    settle_battery(agv);
  }
  world_.finish(end);
}

void Engine::start() {
  for (Agv& agv : agvs_) {
    queue_.push(kStart, agv.id, Event::Kind::Start);
    const auto& transports = scenario_.agvs[agv.id.index()].transports;
    for (std::size_t i = 0; i < transports.size(); ++i)
      queue_.push(kStart + transports[i].release, agv.id, Event::Kind::OrderReleased, i);
    predict_touches(agv.id);
    predict_empty_battery(agv);
  }
  schedule_faults();
  if (scenario_.operator_help.on) queue_.push(kStart, EntityId{}, Event::Kind::OperatorLooks);
}

void Engine::handle(const Event& event) {
  switch (event.kind) {
    case Event::Kind::Contact:
      return bodies_touch(event.entity, event.payload);
    case Event::Kind::BodyAppears:
      return body_appears(event.entity);
    case Event::Kind::BodyLeaves:
      return body_leaves(event.entity);
    case Event::Kind::OperatorLooks:
      return operator_looks();
    default:
      break;
  }
  Agv& agv = agvs_[event.entity.index()];
  switch (event.kind) {
    case Event::Kind::Start: {
      fp_event start{};
      start.kind = FP_EVENT_START;
      tell(agv, start);
      break;
    }
    case Event::Kind::OrderReleased:
      order_released(agv, event.payload);
      break;
    case Event::Kind::ActivityEnds:
      if (event.stamp == agv.activity_stamp && agv.activity) activity_ends(agv);
      break;
    case Event::Kind::CallTakesEffect:
      call_takes_effect(agv);
      break;
    case Event::Kind::MessageArrives:
      message_arrives(agv, static_cast<std::uint32_t>(event.payload));
      break;
    case Event::Kind::TimerGoesOff:
      timer_goes_off(agv, static_cast<std::uint32_t>(event.payload), event.stamp);
      break;
    case Event::Kind::AgentIsFree:
      agent_is_free(agv);
      break;
    case Event::Kind::BatteryEmpty:
      if (event.stamp == agv.battery_stamp) battery_empty(agv);
      break;
    case Event::Kind::FaultStrikes:
      fault_strikes(agv, event.payload);
      break;
    case Event::Kind::FaultOver:
      fault_over(agv, event.payload);
      break;
    case Event::Kind::ScannerLooks:
      if (event.stamp == agv.scanner_stamp) scanner_looks(agv);
      break;
    case Event::Kind::OperatorComes:
      operator_comes(agv, static_cast<Assist>(event.payload), event.stamp);
      break;
    default:
      break;
  }
}

void Engine::trace(EntityId entity, TraceKind kind, std::uint64_t a, std::uint64_t b, std::string_view text,
                   std::uint32_t bytes) {
  const TraceRecord record{now_, entity, kind, a, b, bytes};
  digest_.append(record);
  if (sink_ != nullptr) sink_->record(record, text);
  if (!read_by_laws_.has(kind)) return;
  for (const auto& [law, kinds] : readers_) {
    if (kinds.has(kind)) law->happened(record);
  }
}

void Engine::note(Agv& agv, TraceKind kind, std::string_view text) {
  const std::uint64_t hash = name_hash(text);
  if (kind == TraceKind::Probe) probes_.declare(text, hash);
  trace(agv.id, kind, hash, 0, text);
}

void Engine::file_findings() {
  std::vector<Incident> incidents;
  std::vector<ProbeCount> probes = probes_.counts();
  outcome_.counters.probes_left_out = probes_.left_out();
  for (const auto& law : laws_) {
    LawFindings findings = law->findings();
    std::ranges::move(findings.incidents, std::back_inserter(incidents));
    std::ranges::move(findings.met, std::back_inserter(probes));
    if (law != laws_.front()) continue;
    file_violations(outcome_, std::move(findings.violations));
    if (findings.min_clearance_m)
      outcome_.min_clearance_um = static_cast<std::int64_t>(std::floor(*findings.min_clearance_m * 1e6));
    outcome_.counters.distance_evaluations = findings.distance_evaluations;
    outcome_.counters.perimeter_checks = findings.perimeter_checks;
  }
  file_incidents(outcome_, std::move(incidents));
  file_probes(outcome_, std::move(probes));
}

// Sums over the fleet, each rounded once.
void Engine::close_books() {
  Counters& counters = outcome_.counters;
  double driven_m = 0.0, start = 0.0, end = 0.0;
  BatteryBook book;
  for (const Agv& agv : agvs_) {
    counters.safe_mode_ns += agv.safe_mode_ns;
    driven_m += agv.driven_m;
    start += scenario_.agvs[agv.id.index()].battery;
    end += agv.battery;
    book.driven += agv.book.driven;
    book.idled += agv.book.idled;
    book.charged += agv.book.charged;
  }
  const auto ppb = [](double share) { return static_cast<std::uint64_t>(std::llround(share * 1e9)); };
  counters.distance_um = static_cast<std::uint64_t>(std::llround(driven_m * 1e6));
  counters.battery_start_ppb = ppb(start);
  counters.battery_end_ppb = ppb(end);
  counters.battery_driven_ppb = ppb(book.driven);
  counters.battery_idled_ppb = ppb(book.idled);
  counters.battery_charged_ppb = ppb(book.charged);
  counters.under_way = counters.receptions + counters.duplicates - counters.receptions_lost - counters.received;
}

Outcome Engine::outcome() {
  Counters& counters = outcome_.counters;
  close_books();
  counters.events = digest_.record_count();
  outcome_.simulated_ns = static_cast<std::uint64_t>(scenario_.horizon.count());
  outcome_.agv_count = static_cast<std::uint32_t>(agvs_.size());
  const auto held_by_fault = [](const Halt& halt) {
    return halt.reason == Halt::Reason::Breakdown || halt.reason == Halt::Reason::ProtectiveStop;
  };
  const bool excused =
      std::ranges::any_of(agvs_, [&](const Agv& agv) { return std::ranges::any_of(agv.halts, held_by_fault); });
  outcome_.stuck = transports_are_open() && !excused && now_ - last_progress_ >= scenario_.stuck_after;
  file_findings();
  outcome_.contact = outcome_.contact || counters.contacts > 0;
  outcome_.digest = digest_.value();
  outcome_.running_digests = digest_.running();
  return std::move(outcome_);
}

void check_abi(const fp_agent_type& agent) {
  if (agent.struct_size < sizeof(fp_agent_type) || agent.abi_major != FP_ABI_MAJOR) {
    throw InputError("agent", "speaks another version of fleetproof/agent.h (this program: " +
                                  std::to_string(FP_ABI_MAJOR) + "); rebuild it against this version's header");
  }
  if (agent.name == nullptr || agent.name[0] == '\0')
    throw InputError("agent", "has no name; give its fp_agent_type one");
  if (agent.description == nullptr || agent.create == nullptr || agent.on_event == nullptr ||
      agent.destroy == nullptr) {
    throw InputError(
        agent.name,
        "has a null member in its fp_agent_type; description, create, on_event and destroy must all be there");
  }
}

Outcome simulate(const Scenario& scenario, const fp_agent_type& agent, std::span<const std::unique_ptr<Law>> laws,
                 TraceSink* sink, const char* agent_config) {
  try {
    Engine engine(scenario, agent, laws, sink, agent_config);
    engine.run();
    return engine.outcome();
  } catch (const InvariantViolation& bug) {
    Outcome failed;
    failed.engine_error = true;
    failed.message = bug.what();
    failed.agv_count = static_cast<std::uint32_t>(scenario.agvs.size());
    failed.simulated_ns = static_cast<std::uint64_t>(scenario.horizon.count());
    return failed;
  }
}

}  // namespace fleetproof
