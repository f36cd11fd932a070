#pragma once

#include <map>
#include <memory>
#include <vector>

#include "core/outcome/trace_records.hpp"
#include "laws/laws.hpp"
#include "tests/laws/teller.hpp"
#include "tests/support/at_seconds.hpp"
#include "tests/support/trace_parts.hpp"

// A law that is told by hand what happens, record by record.
namespace fleetproof::test {

class Told {
 public:
  // Every AGV stands at its start, every obstacle where it is.
  Told(const Scenario& scenario, std::string_view law)
      : scenario_(scenario),
        law_(find_law(law)->make(scenario)),
        teller_(*law_, scenario.entity_count()),
        kinds_(law_->reads()) {
    for (std::size_t i = 0; i < scenario.agvs.size(); ++i)
      stand(static_cast<std::uint32_t>(i), scenario.map->station(scenario.agvs[i].start).position_m, 0.0);
    for (std::size_t i = 0; i < scenario.obstacles.size(); ++i) {
      begin(rest_piece(EntityId{scenario.agvs.size() + i}, scenario.obstacles[i].footprint, scenario.obstacles[i].pose,
                       kStart));
    }
  }

  Told& stand(std::uint32_t agv, const Vec2& at_m, double from_s) {
    return begin(rest_piece(EntityId{agv}, scenario_.type_of(scenario_.agvs[agv]).footprint,
                            {at_m, scenario_.agvs[agv].heading}, at_seconds(from_s)));
  }

  // The law is called only for the kinds of records that it reads.
  template <class What>
  Told& record(double at_s, std::uint32_t entity, const What& what) {
    const TraceRecord record = trace_record(at_seconds(at_s), EntityId{entity}, what);
    if (law_->hears_together()) law_->together(part_of(record));
    if (kinds_.has(record.kind)) law_->happened(record);
    return *this;
  }
  Told& begins(double at_s, std::uint32_t agv, ActivityKind kind, std::uint64_t subject = 0) {
    return record(at_s, agv, traced::ActivityBegins{kind, subject});
  }
  Told& ends(double at_s, std::uint32_t agv, ActivityKind kind, bool as_planned = true) {
    return record(at_s, agv, traced::ActivityEnds{kind, as_planned});
  }
  Told& released(double at_s, std::uint32_t agv, std::uint32_t transport) {
    return record(at_s, agv, traced::OrderReleased{TransportId{transport}});
  }
  Told& done(double at_s, std::uint32_t agv, std::uint32_t transport) {
    return record(at_s, agv, traced::TransportDone{TransportId{transport}});
  }
  Told& load_at_station(double at_s, std::uint32_t agv, std::uint32_t load, std::uint32_t station) {
    return record(at_s, agv, traced::LoadMoves{LoadId{load}, {Holder::Kind::Station, station}});
  }
  Told& load_on_agv(double at_s, std::uint32_t agv, std::uint32_t load) {
    return record(at_s, agv, traced::LoadMoves{LoadId{load}, {Holder::Kind::Agv, agv}});
  }
  Told& waits_for(double at_s, std::uint32_t agv, std::uint32_t other) {
    return record(at_s, agv, traced::WaitingFor{AgvId{other}});
  }
  Told& touches(double at_s, std::uint32_t body, std::uint32_t other) {
    return record(at_s, body, traced::Contact{EntityId{other}});
  }
  Told& appears(double at_s, std::uint32_t body, std::uint32_t station = 0) {
    return record(at_s, body, traced::Appears{StationId{station}});
  }
  Told& leaves(double at_s, std::uint32_t body) { return record(at_s, body, traced::Leaves{}); }
  Told& battery_empty(double at_s, std::uint32_t agv) { return record(at_s, agv, traced::BatteryEmpty{}); }
  // `number`: of the fault in the scenario.
  Told& strikes(double at_s, std::uint32_t agv, Fault::Kind fault, std::uint64_t number = 0) {
    return record(at_s, agv, traced::FaultStrikes{fault, number});
  }
  Told& sends(double at_s, std::uint32_t sender, std::uint32_t receiver, std::uint64_t hash, std::uint32_t bytes = 0) {
    return record(at_s, sender, traced::Sent{AgvId{receiver}, hash, bytes});
  }
  // `delivery` is Received, or a kind of loss.
  Told& reception(double at_s, std::uint32_t receiver, TraceKind delivery, std::uint32_t sender, std::uint64_t hash) {
    return record(at_s, receiver, traced::Reception{delivery, AgvId{sender}, hash});
  }
  // Once more.
  Told& copy(double at_s, std::uint32_t receiver, std::uint32_t sender, std::uint64_t hash) {
    const traced::Reception received{TraceKind::Received, AgvId{sender}, hash};
    law_->together(part_of(trace_record(at_seconds(at_s), AgvId{receiver}, received), true));
    return *this;
  }

  LawResults finish(double end_s) {
    for (auto& [entity, piece] : open_) {
      piece.end = at_seconds(end_s);
      teller_.ends(piece);
    }
    law_->finish(at_seconds(end_s));
    LawResults findings = law_->findings();
    Outcome sorted;
    file_incidents(sorted, std::move(findings.incidents));
    findings.incidents = sorted.incidents;
    return findings;
  }

 private:
  Told& begin(Piece piece) {
    if (const auto before = open_.find(piece.entity); before != open_.end()) {
      before->second.end = piece.begin;
      teller_.ends(before->second);
    }
    piece.number = number_++;
    piece.planned_box = piece.swept_box(piece.end);
    open_[piece.entity] = piece;
    teller_.begins(open_[piece.entity]);
    return *this;
  }

  const Scenario& scenario_;
  std::unique_ptr<Law> law_;
  Teller teller_;
  TraceKinds kinds_;
  std::map<EntityId, Piece> open_;
  std::uint64_t number_ = 0;
};

inline std::vector<IncidentKind> kinds_of(const std::vector<Incident>& incidents) {
  std::vector<IncidentKind> kinds;
  for (const Incident& incident : incidents) kinds.push_back(incident.kind);
  return kinds;
}

}  // namespace fleetproof::test
