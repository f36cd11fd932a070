#include "laws/containment_law.hpp"

#include <map>
#include <optional>
#include <utility>

#include "core/outcome/trace_records.hpp"
#include "core/scenario/order_table.hpp"
#include "laws/whereabouts.hpp"

namespace fleetproof {
namespace {

struct TrackedLoad {
  Holder holder;
  std::optional<TransportId> transport;
  std::optional<std::size_t> misplaced;  // its open incident
  bool delivered = false;
};

// A pick or drop under way.
struct Handling {
  ActivityKind kind = ActivityKind::Park;
  LoadId load;
  bool moved = false;
};

class ContainmentLaw final : public Law {
 public:
  explicit ContainmentLaw(const Scenario& scenario);

  Pieces hears_pieces() const override { return Pieces::Beginnings; }
  void piece_started(const Piece& piece) override { bodies_.note(piece); }
  TraceKinds reads() const override {
    return {TraceKind::LoadMoves, TraceKind::OrderReleased, TraceKind::TransportDone, TraceKind::ActivityBegins,
            TraceKind::ActivityEnds};
  }
  ActivityKinds reads_about() const override { return {ActivityKind::Pick, ActivityKind::Drop}; }
  void happened(const TraceRecord& record) override;
  void finish(SimTime end) override;
  LawResults findings() const override;

 private:
  // `owner` is the AGV of the load's transport; invalid: it is open, and no AGV carries it.
  void appears(EntityId owner, LoadId number, TrackedLoad& load, const Holder& where, SimTime at);
  void moves(EntityId owner, LoadId number, TrackedLoad& load, const Holder& to, SimTime at);
  void check_put_down(EntityId owner, LoadId number, TrackedLoad& load, StationId station, SimTime at);
  void handling_ends(const TraceRecord& record);
  void transport_done(const TraceRecord& record);
  // Whether `agv` is handling the load in this way, at this station.
  bool handles(EntityId agv, ActivityKind kind, LoadId load, StationId station, SimTime at) const;
  bool carries_another(EntityId agv, LoadId load) const;
  void accuse(IncidentKind kind, EntityId a, EntityId b, SimTime at, LoadId load) {
    incidents_.push_back({kind, a, b, at, at, std::int64_t{load.value}});
  }

  Whereabouts bodies_;
  OrderTable orders_;
  std::optional<TransportId> released_;  // its load is about to appear
  std::map<LoadId, TrackedLoad> loads_;
  std::map<EntityId, Handling> handling_;
  std::vector<Incident> incidents_;
};

ContainmentLaw::ContainmentLaw(const Scenario& scenario) : bodies_(scenario), orders_(scenario) {}

void ContainmentLaw::happened(const TraceRecord& record) {
  switch (record.kind) {
    case TraceKind::OrderReleased:
      released_ = read<traced::OrderReleased>(record).transport;
      break;
    case TraceKind::TransportDone:
      transport_done(record);
      break;
    case TraceKind::ActivityEnds:
      handling_ends(record);
      break;
    case TraceKind::ActivityBegins: {
      const auto begun = read<traced::ActivityBegins>(record);
      if (begun.activity == ActivityKind::Pick || begun.activity == ActivityKind::Drop)
        handling_[record.entity] = {begun.activity, begun.load(), false};
      break;
    }
    case TraceKind::LoadMoves: {
      const auto [load, to] = read<traced::LoadMoves>(record);
      const auto [known, is_new] = loads_.try_emplace(load);
      if (is_new) {
        appears(record.entity, load, known->second, to, record.at);
      } else {
        moves(record.entity, load, known->second, to, record.at);
      }
      break;
    }
    default:
      break;
  }
}

void ContainmentLaw::appears(EntityId owner, LoadId number, TrackedLoad& load, const Holder& where, SimTime at) {
  load.holder = where;
  load.transport = std::exchange(released_, std::nullopt);
  if (!load.transport || !orders_.has(*load.transport) || where.kind != Holder::Kind::Station) {
    return accuse(IncidentKind::LoadMovedByNobody, owner, {}, at, number);
  }
  check_put_down(owner, number, load, StationId{where.index}, at);
}

void ContainmentLaw::moves(EntityId owner, LoadId number, TrackedLoad& load, const Holder& to, SimTime at) {
  if (load.misplaced) incidents_[*load.misplaced].last = at;
  load.misplaced.reset();
  const Holder from = std::exchange(load.holder, to);
  const EntityId agv{to.kind == Holder::Kind::Agv ? to.index : from.index};
  if (to.kind == Holder::Kind::Withdrawn) {
    if (from.kind != Holder::Kind::Station) accuse(IncidentKind::LoadMovedByNobody, owner, {}, at, number);
  } else if (to.kind == Holder::Kind::Agv && from.kind == Holder::Kind::Agv) {
    accuse(IncidentKind::LoadHeldByTwo, EntityId{from.index}, EntityId{to.index}, at, number);
  } else if (to.kind == Holder::Kind::Floor || to.kind == Holder::Kind::ClearedAway) {
    // It falls from an AGV, and is cleared away from the floor.
    const auto must_come_from = to.kind == Holder::Kind::Floor ? Holder::Kind::Agv : Holder::Kind::Floor;
    if (from.kind != must_come_from) accuse(IncidentKind::LoadMovedByNobody, owner, {}, at, number);
  } else if (to.kind == from.kind || from.kind == Holder::Kind::Floor || from.is_gone()) {
    accuse(IncidentKind::LoadMovedByNobody, owner, {}, at, number);
  } else {
    const bool taken = to.kind == Holder::Kind::Agv;
    const StationId station{taken ? from.index : to.index};
    if (!handles(agv, taken ? ActivityKind::Pick : ActivityKind::Drop, number, station, at)) {
      accuse(IncidentKind::LoadMovedByNobody, agv, {}, at, number);
    }
  }
  if (to.kind == Holder::Kind::Agv && carries_another(agv, number))
    accuse(IncidentKind::LoadPickedByFullAgv, agv, {}, at, number);
  if (to.kind == Holder::Kind::Station) check_put_down(owner, number, load, StationId{to.index}, at);
  // Of two AGVs that pick it, one gets it; of a load that is withdrawn, none does.
  for (auto& [handler, handling] : handling_) handling.moved = handling.moved || handling.load == number;
}

void ContainmentLaw::check_put_down(EntityId owner, LoadId number, TrackedLoad& load, StationId station, SimTime at) {
  if (!load.transport || !orders_.has(*load.transport)) return;
  const TransportOrder& order = orders_.order(*load.transport);
  if (station == order.from || station == order.to) return;
  load.misplaced = incidents_.size();
  accuse(IncidentKind::LoadAtWrongStation, owner, {}, at, number);
}

void ContainmentLaw::handling_ends(const TraceRecord& record) {
  const auto [activity, as_planned] = read<traced::ActivityEnds>(record);
  const auto handling = handling_.find(record.entity);
  if (handling == handling_.end() || activity != handling->second.kind) return;
  const bool had_load = loads_.contains(handling->second.load);  // an empty move has none
  if (had_load && as_planned && !handling->second.moved)
    accuse(IncidentKind::LoadVanished, record.entity, {}, record.at, handling->second.load);
  handling_.erase(handling);
}

void ContainmentLaw::transport_done(const TraceRecord& record) {
  const TransportId done = read<traced::TransportDone>(record).transport;
  for (auto& [number, load] : loads_) {
    if (load.transport != done) continue;
    if (load.delivered) accuse(IncidentKind::LoadDeliveredTwice, record.entity, {}, record.at, number);
    load.delivered = true;
    const bool there = orders_.has(done) && load.holder == Holder{Holder::Kind::Station, orders_.order(done).to.value};
    if (!there && !load.misplaced) accuse(IncidentKind::LoadAtWrongStation, record.entity, {}, record.at, number);
  }
}

bool ContainmentLaw::handles(EntityId agv, ActivityKind kind, LoadId load, StationId station, SimTime at) const {
  const auto handling = handling_.find(agv);
  if (handling == handling_.end() || handling->second.kind != kind || handling->second.load != load) return false;
  return agv.index() < bodies_.agv_count() && bodies_.stands_at(agv, station, at);
}

bool ContainmentLaw::carries_another(EntityId agv, LoadId load) const {
  for (const auto& [number, tracked] : loads_) {
    if (number != load && tracked.holder == Holder{Holder::Kind::Agv, agv.value}) return true;
  }
  return false;
}

void ContainmentLaw::finish(SimTime end) {
  for (const auto& [number, load] : loads_) {
    if (load.misplaced) incidents_[*load.misplaced].last = end;
  }
}

LawResults ContainmentLaw::findings() const {
  LawResults findings;
  findings.incidents = incidents_;
  return findings;
}

}  // namespace

std::unique_ptr<Law> make_containment_law(const Scenario& scenario) {
  return std::make_unique<ContainmentLaw>(scenario);
}

}  // namespace fleetproof
