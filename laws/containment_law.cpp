#include "laws/containment_law.hpp"

#include <map>
#include <optional>
#include <utility>

#include "core/motion/activity.hpp"
#include "laws/whereabouts.hpp"

namespace fleetproof {
namespace {

struct Booked {
  Holder holder;
  std::optional<std::uint64_t> transport;
  std::optional<std::size_t> misplaced;  // its open incident
  bool delivered = false;
};

// A pick or drop under way.
struct Handling {
  ActivityKind kind = ActivityKind::Park;
  std::uint64_t load = 0;
  bool moved = false;
};

class ContainmentLaw final : public Law {
 public:
  explicit ContainmentLaw(const Scenario& scenario);

  void piece_started(const Piece& piece) override { bodies_.note(piece); }
  void piece_ended(const Piece&) override {}
  TraceKinds reads() const override {
    return {TraceKind::LoadMoves, TraceKind::OrderReleased, TraceKind::TransportDone, TraceKind::ActivityBegins,
            TraceKind::ActivityEnds};
  }
  void happened(const TraceRecord& record) override;
  void finish(SimTime end) override;
  LawFindings findings() const override;

 private:
  void appears(const TraceRecord& record, const Holder& at);
  void moves(const TraceRecord& record, Booked& load, const Holder& to);
  void check_taken(const TraceRecord& record, const Booked& load, EntityId taker);
  void check_put_down(const TraceRecord& record, Booked& load, StationId at);
  void handling_ends(const TraceRecord& record);
  void transport_done(const TraceRecord& record);
  // Whether `agv` is handling the load in this way, at this station.
  bool handles(EntityId agv, ActivityKind kind, std::uint64_t load, StationId station, SimTime at) const;
  bool carries_another(EntityId agv, std::uint64_t load) const;
  void accuse(IncidentKind kind, EntityId a, EntityId b, SimTime at, std::uint64_t load) {
    incidents_.push_back({kind, a, b, at, at, static_cast<std::int64_t>(load)});
  }

  Whereabouts bodies_;
  std::vector<TransportOrder> orders_;     // by number of the transport
  std::optional<std::uint64_t> released_;  // its load is about to appear
  std::map<std::uint64_t, Booked> loads_;
  std::map<EntityId, Handling> handling_;
  std::vector<Incident> incidents_;
};

ContainmentLaw::ContainmentLaw(const Scenario& scenario) : bodies_(scenario) {
  for (const AgvSetup& agv : scenario.agvs) orders_.insert(orders_.end(), agv.transports.begin(), agv.transports.end());
}

void ContainmentLaw::happened(const TraceRecord& record) {
  switch (record.kind) {
    case TraceKind::OrderReleased:
      released_ = record.a;
      break;
    case TraceKind::TransportDone:
      transport_done(record);
      break;
    case TraceKind::ActivityEnds:
      handling_ends(record);
      break;
    case TraceKind::ActivityBegins: {
      const auto kind = static_cast<ActivityKind>(record.a);
      if (kind == ActivityKind::Pick || kind == ActivityKind::Drop) handling_[record.entity] = {kind, record.b, false};
      break;
    }
    case TraceKind::LoadMoves: {
      const Holder to{static_cast<Holder::Kind>(record.b >> 32), static_cast<std::uint32_t>(record.b)};
      const auto known = loads_.find(record.a);
      if (known == loads_.end()) {
        appears(record, to);
      } else {
        moves(record, known->second, to);
      }
      break;
    }
    default:
      break;
  }
}

void ContainmentLaw::appears(const TraceRecord& record, const Holder& at) {
  Booked& load = loads_[record.a];
  load.holder = at;
  load.transport = std::exchange(released_, std::nullopt);
  if (!load.transport || *load.transport >= orders_.size() || at.kind != Holder::Kind::Station) {
    return accuse(IncidentKind::LoadMovedByNobody, record.entity, {}, record.at, record.a);
  }
  check_put_down(record, load, StationId{at.index});
}

void ContainmentLaw::moves(const TraceRecord& record, Booked& load, const Holder& to) {
  if (load.misplaced) incidents_[*load.misplaced].last = record.at;
  load.misplaced.reset();
  const Holder from = std::exchange(load.holder, to);
  const EntityId agv{to.kind == Holder::Kind::Agv ? to.index : from.index};
  if (to.kind == Holder::Kind::Agv && from.kind == Holder::Kind::Agv) {
    accuse(IncidentKind::LoadHeldByTwo, EntityId{from.index}, EntityId{to.index}, record.at, record.a);
  } else if (to.kind == Holder::Kind::Floor || to.kind == Holder::Kind::ClearedAway) {
    // It falls from an AGV, and is cleared away from the floor.
    const auto must_come_from = to.kind == Holder::Kind::Floor ? Holder::Kind::Agv : Holder::Kind::Floor;
    if (from.kind != must_come_from) accuse(IncidentKind::LoadMovedByNobody, record.entity, {}, record.at, record.a);
  } else if (to.kind == from.kind || from.kind == Holder::Kind::Floor || from.kind == Holder::Kind::ClearedAway) {
    accuse(IncidentKind::LoadMovedByNobody, record.entity, {}, record.at, record.a);
  } else {
    const bool taken = to.kind == Holder::Kind::Agv;
    const StationId station{taken ? from.index : to.index};
    if (!handles(agv, taken ? ActivityKind::Pick : ActivityKind::Drop, record.a, station, record.at)) {
      accuse(IncidentKind::LoadMovedByNobody, agv, {}, record.at, record.a);
    }
  }
  if (to.kind == Holder::Kind::Agv && carries_another(agv, record.a))
    accuse(IncidentKind::LoadPickedByFullAgv, agv, {}, record.at, record.a);
  if (to.kind == Holder::Kind::Station) check_put_down(record, load, StationId{to.index});
  if (const auto handling = handling_.find(agv); handling != handling_.end() && handling->second.load == record.a)
    handling->second.moved = true;
}

void ContainmentLaw::check_put_down(const TraceRecord& record, Booked& load, StationId at) {
  if (!load.transport || *load.transport >= orders_.size()) return;
  const TransportOrder& order = orders_[*load.transport];
  if (at == order.from || at == order.to) return;
  load.misplaced = incidents_.size();
  accuse(IncidentKind::LoadAtWrongStation, record.entity, {}, record.at, record.a);
}

void ContainmentLaw::handling_ends(const TraceRecord& record) {
  const auto handling = handling_.find(record.entity);
  if (handling == handling_.end() || record.a != static_cast<std::uint64_t>(handling->second.kind)) return;
  const bool had_load = loads_.contains(handling->second.load);  // an empty move has none
  const bool as_planned = record.b == 1;
  if (had_load && as_planned && !handling->second.moved)
    accuse(IncidentKind::LoadVanished, record.entity, {}, record.at, handling->second.load);
  handling_.erase(handling);
}

void ContainmentLaw::transport_done(const TraceRecord& record) {
  for (auto& [number, load] : loads_) {
    if (load.transport != record.a) continue;
    if (load.delivered) accuse(IncidentKind::LoadDeliveredTwice, record.entity, {}, record.at, number);
    load.delivered = true;
    const bool there = *load.transport < orders_.size() &&
                       load.holder == Holder{Holder::Kind::Station, orders_[*load.transport].to.value};
    if (!there && !load.misplaced) accuse(IncidentKind::LoadAtWrongStation, record.entity, {}, record.at, number);
  }
}

bool ContainmentLaw::handles(EntityId agv, ActivityKind kind, std::uint64_t load, StationId station, SimTime at) const {
  const auto handling = handling_.find(agv);
  if (handling == handling_.end() || handling->second.kind != kind || handling->second.load != load) return false;
  return agv.index() < bodies_.agv_count() && bodies_.stands_at(agv, station, at);
}

bool ContainmentLaw::carries_another(EntityId agv, std::uint64_t load) const {
  for (const auto& [number, booked] : loads_) {
    if (number != load && booked.holder == Holder{Holder::Kind::Agv, agv.value}) return true;
  }
  return false;
}

void ContainmentLaw::finish(SimTime end) {
  for (const auto& [number, load] : loads_) {
    if (load.misplaced) incidents_[*load.misplaced].last = end;
  }
}

LawFindings ContainmentLaw::findings() const {
  LawFindings findings;
  findings.incidents = incidents_;
  return findings;
}

}  // namespace

std::unique_ptr<Law> make_containment_law(const Scenario& scenario) {
  return std::make_unique<ContainmentLaw>(scenario);
}

}  // namespace fleetproof
