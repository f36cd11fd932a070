#include "core/world.hpp"

#include <algorithm>

#include "core/error.hpp"

namespace fleetproof {

// Two bodies touch when less than this is between them: well below any clearance a person would measure, well above rounding.
constexpr double kTouch_m = 1e-6;

const char* name_of(ActivityKind kind) {
  switch (kind) {
    case ActivityKind::Drive: return "drive";
    case ActivityKind::Turn: return "turn";
    case ActivityKind::Transmit: return "transmit";
    case ActivityKind::Pick: return "pick";
    case ActivityKind::Drop: return "drop";
    case ActivityKind::Park: return "park";
    case ActivityKind::Charge: return "charge";
  }
  return "?";
}

World::World(const Scenario& scenario, std::span<const std::unique_ptr<Law>> laws) : scenario_(scenario), laws_(laws) {
  bodies_.resize(scenario.agvs.size() + scenario.obstacles.size());
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    Body& body = bodies_[i];
    body.is_agv = i < scenario.agvs.size();
    Pose pose;
    if (body.is_agv) {
      const AgvSetup& agv = scenario.agvs[i];
      body.footprint = scenario.type_of(agv).footprint;
      pose = {scenario.map->station(agv.start).position_m, agv.heading};
    } else {
      const ObstacleSetup& obstacle = scenario.obstacles[i - scenario.agvs.size()];
      body.footprint = obstacle.footprint;
      pose = obstacle.pose;
    }
    body.piece = rest_piece(EntityId{i}, body.footprint, pose, kStart);
    body.piece.number = pieces_++;
    body.planned_box = body.piece.swept_box(kForever);
    for (const auto& law : laws_) law->piece_started(body.piece);
  }
}

State World::state_at(SimTime t) const {
  State state{.at = t, .spatial = {}, .containment = loads_};
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Body& body = bodies_[i];
    state.spatial.push_back({EntityId{i}, body.piece.pose_at(t), body.footprint, body.is_agv, body.piece.manner != Manner::Rest});
  }
  return state;
}

void World::continue_with(EntityId id, Piece next) {
  Body& body = bodies_[id.index()];
  ensure(next.begin >= body.piece.begin && next.begin <= body.piece.end, "a piece ends within its planned interval");
  body.piece.end = next.begin;
  for (const auto& law : laws_) law->piece_ended(body.piece);
  next.number = pieces_++;
  body.piece = next;
  body.planned_box = next.swept_box(next.end);
  for (const auto& law : laws_) law->piece_started(body.piece);
}

void World::predict_touches(EntityId id, std::vector<TouchPrediction>& out) {
  const Body& mine = body(id);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Body& other = bodies_[i];
    const EntityId other_id{i};
    if (other_id == id || !mine.planned_box.overlaps(other.planned_box)) continue;
    if (mine.piece.manner == Manner::Rest && other.piece.manner == Manner::Rest && mine.piece.begin > kStart) continue;
    if (have_touched(id, other_id)) continue;
    const Interval common{std::max(mine.piece.begin, other.piece.begin), std::min({mine.piece.end, other.piece.end, kStart + scenario_.horizon})};
    if (common.begin > common.end) continue;
    if (const auto at = first_below(mine.piece, other.piece, common, kTouch_m, evaluations_)) {
      out.push_back({*at, id, other_id, mine.piece.number, other.piece.number});
    }
  }
}

void World::remember_touch(EntityId a, EntityId b) { touched_.emplace_back(std::min(a, b), std::max(a, b)); }

bool World::have_touched(EntityId a, EntityId b) const {
  return std::ranges::find(touched_, std::pair{std::min(a, b), std::max(a, b)}) != touched_.end();
}

void World::finish(SimTime end) {
  for (Body& body : bodies_) {
    body.piece.end = std::min(body.piece.end, end);
    for (const auto& law : laws_) law->piece_ended(body.piece);
  }
  for (const auto& law : laws_) law->finish(end);
}

LoadId World::add_load(TransportId transport, AgvId carrier, StationId at, StationId destination) {
  loads_.push_back({transport, carrier, {Holder::Kind::Station, at.value}, destination});
  return LoadId{loads_.size() - 1};
}

LoadId World::waiting_load(AgvId agv, StationId station) const {
  for (std::size_t i = 0; i < loads_.size(); ++i) {
    const Load& load = loads_[i];
    if (load.carrier == agv && load.holder == Holder{Holder::Kind::Station, station.value} && load.destination != station) return LoadId{i};
  }
  return {};
}

LoadId World::carried_load(AgvId agv) const {
  for (std::size_t i = 0; i < loads_.size(); ++i) {
    if (loads_[i].holder == Holder{Holder::Kind::Agv, agv.value}) return LoadId{i};
  }
  return {};
}

}  // namespace fleetproof
