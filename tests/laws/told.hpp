#pragma once

#include <map>
#include <memory>
#include <vector>

#include "core/motion/activity.hpp"
#include "laws/laws.hpp"

// A law that receives the records of a run one by one, written by hand.
namespace fleetproof::test {

class Told {
 public:
  // Every AGV stands at its start, every obstacle where it is.
  Told(const Scenario& scenario, std::string_view law)
      : scenario_(scenario), law_(find_law(law)->make(scenario)), kinds_(law_->reads()) {
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

  // A record of a kind that the law does not read is not sent to it.
  Told& record(double at_s, std::uint32_t entity, TraceKind kind, std::uint64_t a = 0, std::uint64_t b = 0,
               std::uint32_t bytes = 0) {
    if (kinds_.has(kind)) law_->happened({at_seconds(at_s), EntityId{entity}, kind, a, b, bytes});
    return *this;
  }
  Told& begins(double at_s, std::uint32_t agv, ActivityKind kind, std::uint64_t subject = 0) {
    return record(at_s, agv, TraceKind::ActivityBegins, static_cast<std::uint64_t>(kind), subject);
  }
  Told& ends(double at_s, std::uint32_t agv, ActivityKind kind, bool as_planned = true) {
    return record(at_s, agv, TraceKind::ActivityEnds, static_cast<std::uint64_t>(kind), as_planned ? 1 : 0);
  }
  Told& load_at_station(double at_s, std::uint32_t agv, std::uint64_t load, std::uint32_t station) {
    return record(at_s, agv, TraceKind::LoadMoves, load, station);
  }
  Told& load_on_agv(double at_s, std::uint32_t agv, std::uint64_t load) {
    return record(at_s, agv, TraceKind::LoadMoves, load, std::uint64_t{1} << 32 | agv);
  }

  LawFindings finish(double end_s) {
    for (auto& [entity, piece] : open_) {
      piece.end = at_seconds(end_s);
      law_->piece_ended(piece);
    }
    law_->finish(at_seconds(end_s));
    LawFindings findings = law_->findings();
    Outcome sorted;
    file_incidents(sorted, std::move(findings.incidents));
    findings.incidents = sorted.incidents;
    return findings;
  }

 private:
  Told& begin(Piece piece) {
    if (const auto before = open_.find(piece.entity); before != open_.end()) {
      before->second.end = piece.begin;
      law_->piece_ended(before->second);
    }
    piece.number = number_++;
    piece.planned_box = piece.swept_box(piece.end);
    law_->piece_started(piece);
    open_[piece.entity] = piece;
    return *this;
  }

  const Scenario& scenario_;
  std::unique_ptr<Law> law_;
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
