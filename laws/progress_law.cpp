#include "laws/progress_law.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "core/outcome/trace_records.hpp"
#include "core/outcome/work_and_progress.hpp"
#include "core/scenario/order_table.hpp"
#include "laws/approach.hpp"
#include "laws/fault_watch.hpp"
#include "laws/inferred_waits.hpp"

namespace fleetproof {
namespace {

constexpr int kLooksPerStuckAfter = 12;
constexpr Duration kShortestLook = std::chrono::seconds(1);
constexpr double kWayTakes = 2.0;  // times the time at top speed that a way may take without success
// Transports finished by each of the others, on average; of an open transport, by each AGV.
constexpr std::uint64_t kOvertaken = 2;

// The top speed on the map in the direction in which the AGV is slower.
double slower_way_mps(const LogicalMap& map, const VehicleType& type, bool loaded) {
  const double forward_mps = type.drive_with(loaded, false).speed_mps,
               backward_mps = type.drive_with(loaded, true).speed_mps;
  if (backward_mps >= forward_mps) return forward_mps;
  return std::ranges::any_of(map.lanes(), &Lane::is_backward) ? backward_mps : forward_mps;
}

struct AgvState {
  std::vector<TransportId> open;    // its transports: released and not done. An open one is its own while it carries it
  std::optional<TransportId> work;  // an open one on which it works, as is declared, and which no AGV carries
  std::optional<TransportId> carried;  // transport of the load on it
  SimTime open_since = kStart, active_at = kStart, advanced_at = kStart;
  bool busy = false, off_floor = false;      // off: in the hands of the operator
  ActivityKind doing = ActivityKind::Drive;  // while it is busy
  bool moves_load = false;                   // it picks or drops one
  Duration turned{};                         // its last turn, if no drive has followed
  std::optional<SimTime> charging_since;
  EntityId declared;                             // the AGV for which it waits, as its agent declares
  std::uint64_t done = 0, others_done_then = 0;  // when it last advanced

  bool has_work() const { return work || !open.empty(); }
  std::size_t transports() const { return open.size() + (work ? 1 : 0); }
  // Requires: it has work. What it has to carry out next.
  TransportId next() const { return carried ? *carried : work ? *work : open.front(); }
  // Whether its transports could advance now.
  bool is_expected() const { return has_work() && !charging_since; }
  SimTime still_since() const { return std::max(open_since, active_at); }
  SimTime without_success_since() const { return std::max(open_since, advanced_at); }
};

struct Wait {
  EntityId for_whom;
  bool inferred = false;
};

// An open transport of which no AGV has the load, and which an AGV can take up.
struct FreeOrder {
  TransportId transport;
  SimTime since;                 // it is released, or its load is put down
  std::uint64_t later_done = 0;  // open transports that were released later and are done
};

class ProgressLaw final : public Law {
 public:
  explicit ProgressLaw(const Scenario& scenario);

  void piece_started(const Piece& piece) override {
    look_before(piece.begin);
    bodies_.note(piece);
  }
  // The piece is still there to be looked at.
  void piece_ended(const Piece& piece) override { look_before(piece.end); }
  TraceKinds reads() const override {
    return TraceKinds{TraceKind::OrderReleased, TraceKind::TransportDone, TraceKind::ActivityBegins,
                      TraceKind::ActivityEnds,  TraceKind::WaitingFor,    TraceKind::WorksOn,
                      TraceKind::LoadMoves,     TraceKind::Appears,       TraceKind::Leaves} |
           FaultWatch::reads();
  }
  void happened(const TraceRecord& record) override;
  void finish(SimTime end) override;
  LawResults findings() const override;

 private:
  using Key = std::tuple<IncidentKind, EntityId, TransportId>;  // of a transport: without the AGV

  void goes_on_with(const TraceRecord& record);
  void begins_work(AgvState& agv, EntityId id, const traced::ActivityBegins& begun);
  void charge_begins_or_ends(AgvState& agv, const TraceRecord& record);
  void order_released(const TraceRecord& record);
  void works_on(const TraceRecord& record);
  static void gets_work(AgvState& agv, SimTime at, std::uint64_t others_done);
  void load_moves(const TraceRecord& record);
  void open_load_moves(TransportId transport, const Holder& to, EntityId agv, SimTime at);
  void load_is_gone(TransportId transport, const Holder& to, SimTime at);
  void done(TransportId transport, SimTime at);
  EntityId owner_of(TransportId transport) const;
  void forget(TransportId transport);
  void advanced(AgvState& agv, SimTime at);
  void fleet_advances(SimTime at);
  void look_before(SimTime t);
  void look(SimTime now);
  bool is_stalled(const AgvState& agv, SimTime now) const {
    return agv.is_expected() && !agv.busy && !agv.off_floor && now - still_since(agv) >= stuck_after_;
  }
  // It may be at work, whatever it declares.
  bool is_active(const AgvState& agv, SimTime now) const {
    return agv.busy || agv.charging_since || agv.off_floor ||
           now - std::max(agv.active_at, faults_.last()) < stuck_after_;
  }
  void comes_or_goes(const TraceRecord& record);
  SimTime still_since(const AgvState& agv) const { return std::max(agv.still_since(), faults_.last()); }
  void look_for_deadlocks(SimTime now);
  void look_for_idle_fleet(SimTime now);
  void look_for_livelock(SimTime now);
  Duration longest_way(SimTime now);
  Duration time_of_way(EntityId agv, StationId goal, SimTime now);
  static bool gets_on(const AgvState& agv, const Approach::Gain& gain);
  void look_for_starvation(SimTime now);
  void look_for_orders_not_taken(SimTime now);
  Wait wait_of(EntityId agv, SimTime now);
  void file_circle(const std::vector<EntityId>& circle, const std::map<EntityId, Wait>& waits, SimTime now);
  void file_waits(const std::vector<EntityId>& agvs, const std::map<EntityId, Wait>& waits, SimTime first, SimTime now,
                  std::int64_t value);
  // Files the incident, or continues the incident that is under way. True: it is new. `about`: the transport that it is
  // about, and not its AGV.
  bool goes_on(const Incident& incident, TransportId about = {});

  const Scenario& scenario_;
  Duration stuck_after_, look_every_;
  Whereabouts bodies_;
  InferredWaits inferred_waits_;
  FaultWatch faults_;
  Approach approach_;
  std::vector<AgvState> agvs_;
  OrderTable orders_;
  std::vector<FreeOrder> free_;                 // in order of `since`
  std::vector<TransportId> transport_of_load_;  // invalid: the load comes from nowhere
  std::optional<TransportId> released_;
  std::uint64_t done_ = 0, motions_ = 0, motions_then_ = 0;  // then: when the fleet last advanced
  SimTime fleet_advanced_at_ = kStart, next_look_ = kStart;
  std::map<Key, std::size_t> under_way_, before_;  // as of this look and the one before
  std::vector<Incident> incidents_;
  std::map<std::size_t, std::size_t> deadlock_of_wait_;  // by place in incidents_
};

ProgressLaw::ProgressLaw(const Scenario& scenario)
    : scenario_(scenario),
      stuck_after_(scenario.stuck_after),
      look_every_(std::max(kShortestLook, stuck_after_ / kLooksPerStuckAfter)),
      bodies_(scenario),
      inferred_waits_(scenario, bodies_),
      faults_(scenario),
      approach_(scenario),
      agvs_(scenario.agvs.size()),
      orders_(scenario),
      next_look_(kStart + look_every_) {
  transport_of_load_.reserve(orders_.size());
}

void ProgressLaw::happened(const TraceRecord& record) {
  look_before(record.at);
  if (record.kind == TraceKind::ActivityBegins || record.kind == TraceKind::ActivityEnds) return goes_on_with(record);
  if (faults_.note(record)) return;
  switch (record.kind) {
    case TraceKind::OrderReleased:
      order_released(record);
      break;
    case TraceKind::LoadMoves:
      load_moves(record);
      break;
    case TraceKind::TransportDone:
      done(read<traced::TransportDone>(record).transport, record.at);
      break;
    case TraceKind::WorksOn:
      works_on(record);
      break;
    case TraceKind::WaitingFor:
      agvs_[record.entity.index()].declared = read<traced::WaitingFor>(record).agv;
      break;
    case TraceKind::Appears:
    case TraceKind::Leaves:
      comes_or_goes(record);
      break;
    default:
      break;
  }
}

// An activity begins or ends.
void ProgressLaw::goes_on_with(const TraceRecord& record) {
  AgvState& agv = agvs_[record.entity.index()];
  const ActivityKind activity = traced::activity_of(record);
  const bool begins = record.kind == TraceKind::ActivityBegins;
  if (activity == ActivityKind::Charge) charge_begins_or_ends(agv, record);
  if (!is_work(activity)) return;
  const Duration lasted = begins ? Duration{} : record.at - std::max(agv.active_at, fleet_advanced_at_);
  agv.busy = begins;
  agv.active_at = record.at;
  motions_ += begins ? 1 : 0;
  if (begins) return begins_work(agv, record.entity, read<traced::ActivityBegins>(record));
  if (activity == ActivityKind::Turn) agv.turned = lasted;
  if (activity == ActivityKind::Drive || activity == ActivityKind::Settle) approach_.spend(record.entity, lasted);
  if (activity == ActivityKind::Drive)
    approach_.drive_ends(record.entity, read<traced::ActivityEnds>(record).as_planned);
}

void ProgressLaw::begins_work(AgvState& agv, EntityId id, const traced::ActivityBegins& begun) {
  agv.doing = begun.activity;
  agv.moves_load = begun.load().valid() && (agv.doing == ActivityKind::Pick || agv.doing == ActivityKind::Drop);
  if (agv.doing != ActivityKind::Drive) return;
  approach_.drive_begins(id, begun.segment());
  approach_.spend(id, std::exchange(agv.turned, Duration{}));
}

void ProgressLaw::charge_begins_or_ends(AgvState& agv, const TraceRecord& record) {
  agv.active_at = record.at;
  if (record.kind == TraceKind::ActivityBegins) return void(agv.charging_since = record.at);
  const Duration lasted = record.at - std::exchange(agv.charging_since, std::nullopt).value_or(record.at);
  const bool as_planned = read<traced::ActivityEnds>(record).as_planned;
  if (is_progress(ActivityKind::Charge, as_planned, lasted, stuck_after_)) advanced(agv, record.at);
}

// An AGV that the operator takes off the floor waits for no AGV and blocks no AGV. It starts anew where the operator
// sets it down.
void ProgressLaw::comes_or_goes(const TraceRecord& record) {
  const bool leaves = record.kind == TraceKind::Leaves;
  if (leaves) bodies_.note_leaving(record.entity);
  if (record.entity.index() >= agvs_.size()) return;
  AgvState& agv = agvs_[record.entity.index()];
  agv.off_floor = leaves;
  agv.active_at = record.at;
  if (!leaves) approach_.set_down(record.entity, read<traced::Appears>(record).station);
}

void ProgressLaw::order_released(const TraceRecord& record) {
  if (free_.empty() && std::ranges::none_of(agvs_, &AgvState::has_work)) fleet_advances(record.at);
  const TransportId transport = read<traced::OrderReleased>(record).transport;
  released_ = transport;
  if (orders_.has(transport) && orders_.is_open(transport)) return free_.push_back({transport, record.at});
  AgvState& agv = agvs_[record.entity.index()];
  if (!agv.has_work()) gets_work(agv, record.at, done_ - agv.done);
  agv.open.push_back(transport);
}

void ProgressLaw::gets_work(AgvState& agv, SimTime at, std::uint64_t others_done) {
  agv.open_since = at;
  agv.others_done_then = others_done;
}

void ProgressLaw::works_on(const TraceRecord& record) {
  AgvState& agv = agvs_[record.entity.index()];
  const TransportId transport = read<traced::WorksOn>(record).transport;
  const bool had_work = agv.has_work();
  const bool is_free = std::ranges::find(free_, transport, &FreeOrder::transport) != free_.end();
  agv.work = is_free ? std::optional(transport) : std::nullopt;
  if (!had_work && agv.has_work()) gets_work(agv, record.at, done_ - agv.done);
}

void ProgressLaw::load_moves(const TraceRecord& record) {
  const auto [load, to] = read<traced::LoadMoves>(record);
  if (released_) {
    if (load.index() >= transport_of_load_.size()) transport_of_load_.resize(load.index() + 1);
    transport_of_load_[load.index()] = *std::exchange(released_, std::nullopt);
    return;
  }
  if (load.index() >= transport_of_load_.size()) return;
  const TransportId transport = transport_of_load_[load.index()];
  if (!transport.valid()) return;  // the law of containment files a load that comes from nowhere
  if (to.is_gone()) return load_is_gone(transport, to, record.at);
  if (orders_.has(transport) && orders_.is_open(transport)) open_load_moves(transport, to, record.entity, record.at);
  AgvState& agv = agvs_[record.entity.index()];
  agv.carried.reset();
  if (to.kind == Holder::Kind::Agv) agv.carried = transport;
  if (advances_transport(to)) advanced(agv, record.at);
}

// An open transport is that of the AGV which carries its load. If the load is put down elsewhere than at its
// destination, any AGV may take it up; on the floor, none can.
void ProgressLaw::open_load_moves(TransportId transport, const Holder& to, EntityId agv, SimTime at) {
  if (to == Holder{Holder::Kind::Station, orders_.order(transport).to.value}) return;  // done, as the next record says
  forget(transport);
  if (to.kind == Holder::Kind::Agv) agvs_[agv.index()].open.push_back(transport);
  if (to.kind == Holder::Kind::Station) free_.push_back({transport, at});
}

void ProgressLaw::load_is_gone(TransportId transport, const Holder& to, SimTime at) {
  const EntityId owner = owner_of(transport);
  forget(transport);
  if (to.kind == Holder::Kind::Withdrawn) return;  // nobody has advanced it
  if (owner.valid()) advanced(agvs_[owner.index()], at);
  if (!owner.valid()) fleet_advances(at);
}

void ProgressLaw::done(TransportId transport, SimTime at) {
  const EntityId owner = owner_of(transport);
  if (!owner.valid()) return;
  forget(transport);
  ++agvs_[owner.index()].done;
  ++done_;
  advanced(agvs_[owner.index()], at);
  if (!orders_.is_open(transport)) return;
  for (FreeOrder& order : free_)
    order.later_done += orders_.order(order.transport).release < orders_.order(transport).release ? 1 : 0;
}

// Invalid: no AGV has it.
EntityId ProgressLaw::owner_of(TransportId transport) const {
  if (!orders_.has(transport)) return {};
  if (!orders_.is_open(transport)) return orders_.agv_of(transport);
  const auto has_it = [&](const AgvState& agv) { return std::ranges::find(agv.open, transport) != agv.open.end(); };
  const auto owner = std::ranges::find_if(agvs_, has_it);
  return owner == agvs_.end() ? EntityId{} : EntityId{static_cast<std::size_t>(owner - agvs_.begin())};
}

// It is over, or another AGV has it.
void ProgressLaw::forget(TransportId transport) {
  std::erase_if(free_, [&](const FreeOrder& order) { return order.transport == transport; });
  for (AgvState& agv : agvs_) {
    std::erase(agv.open, transport);
    if (agv.work == transport) agv.work.reset();
  }
}

void ProgressLaw::advanced(AgvState& agv, SimTime at) {
  agv.advanced_at = at;
  agv.others_done_then = done_ - agv.done;
  fleet_advances(at);
}

void ProgressLaw::fleet_advances(SimTime at) {
  fleet_advanced_at_ = at;
  motions_then_ = motions_;
  approach_.begin_anew();
}

// A look sees everything that happens at its instant, in any order of the records.
void ProgressLaw::look_before(SimTime t) {
  for (; next_look_ < t; next_look_ += look_every_) look(next_look_);
}

void ProgressLaw::look(SimTime now) {
  if (!under_way_.empty() || !before_.empty()) before_ = std::exchange(under_way_, {});
  if (faults_.holds_anybody()) return;
  look_for_deadlocks(now);
  look_for_livelock(now);
  look_for_starvation(now);
  look_for_orders_not_taken(now);
}

bool ProgressLaw::goes_on(const Incident& incident, TransportId about) {
  const Key key{incident.kind, about.valid() ? EntityId{} : incident.a, about};
  const auto before = before_.find(key);
  const bool is_new = before == before_.end();
  under_way_[key] = is_new ? incidents_.size() : before->second;
  if (is_new) {
    incidents_.push_back(incident);
  } else {
    incidents_[before->second].a = incident.a;
    incidents_[before->second].last = incident.last;
    incidents_[before->second].value = incident.value;
  }
  return is_new;
}

Wait ProgressLaw::wait_of(EntityId agv, SimTime now) {
  const AgvState& state = agvs_[agv.index()];
  if (state.declared.valid()) return {state.declared, false};
  const TransportOrder& order = orders_.order(state.next());
  return {inferred_waits_.of(agv, state.carried ? order.to : order.from, state.carried.has_value(), now), true};
}

void ProgressLaw::look_for_deadlocks(SimTime now) {
  std::map<EntityId, Wait> waits;  // of the stalled AGVs
  std::vector<EntityId> stalled;
  std::size_t at_work = 0;
  for (std::size_t i = 0; i < agvs_.size(); ++i) {
    at_work += agvs_[i].has_work() || (!free_.empty() && is_active(agvs_[i], now)) ? 1 : 0;
    if (!is_stalled(agvs_[i], now)) continue;
    stalled.push_back(EntityId{i});
    waits[EntityId{i}] = wait_of(EntityId{i}, now);
  }
  bool any_circle = false;
  for (const EntityId start : stalled) {
    std::vector<EntityId> way;
    EntityId at = start;
    while (waits.contains(at) && std::ranges::find(way, at) == way.end()) {
      way.push_back(at);
      at = waits[at].for_whom;
    }
    // A circle is filed from its first member, once.
    if (!way.empty() && at == start && std::ranges::min(way) == start) {
      any_circle = true;
      file_circle(way, waits, now);
    }
  }
  if (at_work == 0) look_for_idle_fleet(now);
  if (any_circle || stalled.empty() || stalled.size() < at_work) return;
  SimTime first = kStart;
  for (const EntityId agv : stalled) first = std::max(first, still_since(agvs_[agv.index()]));
  if (goes_on({IncidentKind::Deadlock, stalled.front(), waits[stalled.front()].for_whom, first, now, 0}))
    file_waits(stalled, waits, first, now, 0);
}

// Open transports wait, and no AGV has declared to work on one: the fleet as a whole stands still. No AGV is active.
void ProgressLaw::look_for_idle_fleet(SimTime now) {
  if (free_.empty()) return;
  SimTime first = std::max(free_.front().since, faults_.last());
  for (const AgvState& agv : agvs_) first = std::max(first, agv.active_at);
  if (now - first >= stuck_after_) goes_on({IncidentKind::Deadlock, {}, {}, first, now, 0});
}

void ProgressLaw::file_circle(const std::vector<EntityId>& circle, const std::map<EntityId, Wait>& waits, SimTime now) {
  SimTime first = kStart;
  for (const EntityId agv : circle) first = std::max(first, still_since(agvs_[agv.index()]));
  const Incident deadlock{IncidentKind::Deadlock,
                          circle.front(),
                          waits.at(circle.front()).for_whom,
                          first,
                          now,
                          static_cast<std::int64_t>(circle.size())};
  if (goes_on(deadlock)) file_waits(circle, waits, first, now, 1);
}

// The deadlock was filed just before.
void ProgressLaw::file_waits(const std::vector<EntityId>& agvs, const std::map<EntityId, Wait>& waits, SimTime first,
                             SimTime now, std::int64_t value) {
  const std::size_t deadlock = incidents_.size() - 1;
  for (const EntityId agv : agvs) {
    const Wait& wait = waits.at(agv);
    if (!wait.for_whom.valid()) continue;
    deadlock_of_wait_[incidents_.size()] = deadlock;
    incidents_.push_back({wait.inferred ? IncidentKind::WaitsInferred : IncidentKind::WaitsDeclared, agv, wait.for_whom,
                          first, now, value});
  }
}

void ProgressLaw::look_for_livelock(SimTime now) {
  const Duration without_success = now - std::max(fleet_advanced_at_, faults_.last());
  if (without_success < 2 * stuck_after_ || motions_ == motions_then_) return;
  const bool still =
      std::ranges::none_of(agvs_, [&](const AgvState& agv) { return agv.busy || now - agv.active_at < stuck_after_; });
  if (still || (free_.empty() && std::ranges::none_of(agvs_, &AgvState::is_expected))) return;
  if (without_success < 2 * stuck_after_ + longest_way(now)) return;
  goes_on(
      {IncidentKind::Livelock, {}, {}, fleet_advanced_at_, now, static_cast<std::int64_t>(motions_ - motions_then_)});
}

// The time that the fleet may take for the way by which one of its AGVs has come nearer to its goal: twice that at top
// speed, or what the drives took that brought it nearer, if that is more. An AGV that is on a long way gets on, even if
// it picks and delivers nothing meanwhile.
Duration ProgressLaw::longest_way(SimTime now) {
  Duration longest{};
  for (std::size_t i = 0; i < agvs_.size(); ++i) {
    const AgvState& agv = agvs_[i];
    if (agv.has_work()) {
      const TransportOrder& order = orders_.order(agv.next());
      longest = std::max(longest, time_of_way(EntityId{i}, agv.carried ? order.to : order.from, now));
      continue;
    }
    // It may be on its way to any load that waits.
    for (const FreeOrder& order : free_)
      longest = std::max(longest, time_of_way(EntityId{i}, orders_.order(order.transport).from, now));
  }
  return longest;
}

Duration ProgressLaw::time_of_way(EntityId id, StationId goal, SimTime now) {
  const AgvState& agv = agvs_[id.index()];
  const Approach::Gain gain = approach_.gain(id, goal);
  const double speed_mps =
      slower_way_mps(*scenario_.map, scenario_.type_of(scenario_.agvs[id.index()]), agv.carried.has_value());
  const Duration under_way = gets_on(agv, gain) ? now - std::max(agv.active_at, fleet_advanced_at_) : Duration{};
  return std::max(seconds(kWayTakes * gain.way_m / speed_mps), gain.took + under_way);
}

// What it does now is a part of its way: a drive that brings it nearer, the first turn before a drive, a transfer of
// its load.
bool ProgressLaw::gets_on(const AgvState& agv, const Approach::Gain& gain) {
  if (!agv.busy) return false;
  if (agv.doing == ActivityKind::Turn) return agv.turned == Duration{};
  return agv.moves_load ||
         ((agv.doing == ActivityKind::Drive || agv.doing == ActivityKind::Settle) && gain.by_last_drive);
}

void ProgressLaw::look_for_starvation(SimTime now) {
  if (agvs_.size() < 2) return;
  for (std::size_t i = 0; i < agvs_.size(); ++i) {
    const AgvState& agv = agvs_[i];
    const std::uint64_t others_done = done_ - agv.done - agv.others_done_then;
    if (!agv.is_expected() || now - std::max(agv.without_success_since(), faults_.last()) < 2 * stuck_after_ ||
        others_done < kOvertaken * (agvs_.size() - 1))
      continue;
    goes_on({IncidentKind::Starvation,
             EntityId{i},
             {},
             agv.without_success_since(),
             now,
             static_cast<std::int64_t>(agv.transports())});
  }
}

// An open transport that nobody takes up while the fleet finishes later ones. It names the AGV that has declared to
// work on it.
void ProgressLaw::look_for_orders_not_taken(SimTime now) {
  for (const FreeOrder& order : free_) {
    const SimTime since = std::max(order.since, faults_.last());
    if (now - since < 2 * stuck_after_ || order.later_done < kOvertaken * agvs_.size()) continue;
    const auto works = std::ranges::find(agvs_, std::optional(order.transport), &AgvState::work);
    const EntityId agv = works == agvs_.end() ? EntityId{} : EntityId{static_cast<std::size_t>(works - agvs_.begin())};
    goes_on({IncidentKind::OrderNotTaken, agv, {}, since, now, std::int64_t{order.transport.value}}, order.transport);
  }
}

void ProgressLaw::finish(SimTime end) {
  look_before(end);
  look(end);
  for (const auto& [wait, deadlock] : deadlock_of_wait_) incidents_[wait].last = incidents_[deadlock].last;
}

LawResults ProgressLaw::findings() const {
  LawResults findings;
  findings.incidents = incidents_;
  return findings;
}

}  // namespace

std::unique_ptr<Law> make_progress_law(const Scenario& scenario) { return std::make_unique<ProgressLaw>(scenario); }

}  // namespace fleetproof
