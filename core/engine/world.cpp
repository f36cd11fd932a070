#include "core/engine/world.hpp"

#include <algorithm>

#include "core/base/error.hpp"
#include "core/base/tolerances.hpp"
#include "core/clearance/swept_region.hpp"

namespace fleetproof {
namespace {

// As near as any law looks, or as the world itself: a touch.
double farthest_look_m(std::span<const std::unique_ptr<Law>> laws) {
  double within_m = kTouch_m;
  for (const auto& law : laws) within_m = std::max(within_m, law->looks_within_m());
  return within_m;
}

}  // namespace

World::World(const Scenario& scenario, std::span<const std::unique_ptr<Law>> laws, TraceSink* sink)
    : scenario_(scenario),
      laws_(laws),
      sink_(sink),
      bodies_(scenario.entity_count()),
      company_(scenario.entity_count(), farthest_look_m(laws)),
      carried_(scenario.agvs.size()),
      loads_of_(scenario.agvs.size()),
      touched_(scenario.entity_count()) {
  listeners_.to_beginnings.reserve(laws.size()), listeners_.to_ends.reserve(laws.size());
  listeners_.to_company.reserve(laws.size());
  for (const auto& law : laws) {
    const Law::Pieces pieces = law->hears_pieces();
    if (pieces == Law::Pieces::All || pieces == Law::Pieces::Beginnings) listeners_.to_beginnings.push_back(law.get());
    if (pieces == Law::Pieces::All || pieces == Law::Pieces::Ends) listeners_.to_ends.push_back(law.get());
    if (law->looks_within_m() > 0.0) listeners_.to_company.push_back(law.get());
  }
  for (std::size_t i = 0; i < scenario.agvs.size(); ++i) {
    const AgvSetup& agv = scenario.agvs[i];
    bodies_[i].is_agv = true;
    put_on_floor(EntityId{i}, scenario.type_of(agv).footprint,
                 {scenario.map->station(agv.start).position_m, agv.heading}, kStart);
  }
  for (std::size_t i = 0; i < scenario.obstacles.size(); ++i) {
    const ObstacleSetup& obstacle = scenario.obstacles[i];
    if (obstacle.appears == Duration::zero())
      put_on_floor(EntityId{scenario.first_obstacle().index() + i}, obstacle.footprint, obstacle.pose, kStart);
  }
}

void World::put_on_floor(EntityId id, const Footprint& footprint, const Pose& pose, SimTime t) {
  Body& body = bodies_[id.index()];
  body.on_floor = true;
  begin(body, rest_piece(id, footprint, pose, t));
}

void World::announce_end(const Piece& piece) {
  if (!company_.near(piece.entity).empty() && !listeners_.to_company.empty()) {
    const auto near = company_.pieces_near(piece.entity);
    for (Law* law : listeners_.to_company) law->had_company(piece, near);
  }
  for (Law* law : listeners_.to_ends) law->piece_ended(piece);
  if (sink_ != nullptr) sink_->piece_ended(piece);
}

void World::take_off_floor(EntityId id, SimTime t) {
  Body& body = bodies_[id.index()];
  body.on_floor = false;
  body.piece.end = t;
  announce_end(body.piece);
  company_.leaves(id);
}

bool World::is_free(const OrientedRectangle& place, double margin_m, SimTime t) const {
  return std::ranges::none_of(bodies_, [&](const Body& body) {
    return body.on_floor && clearance_m(body.piece.body_at(t), place) <= margin_m;
  });
}

bool World::stays_free(const OrientedRectangle& place, double margin_m, SimTime t) const {
  Box box;
  box.add(place);
  box = box.grown(margin_m);
  return is_free(place, margin_m, t) && std::ranges::none_of(bodies_, [&](const Body& body) {
           return body.on_floor && body.piece.manner != Manner::Rest && body.piece.planned_box.overlaps(box);
         });
}

void World::begin(Body& body, const Piece& piece) {
  body.piece = piece;
  body.piece.number = pieces_++;
  body.piece.planned_box = piece.swept_box(piece.end);
  company_.begins(body.piece);
  for (Law* law : listeners_.to_beginnings) law->piece_started(body.piece);
  if (sink_ != nullptr) sink_->piece_started(body.piece);
}

void World::continue_with(EntityId id, const Piece& next) {
  Body& body = bodies_[id.index()];
  ensure(next.begin >= body.piece.begin && next.begin <= body.piece.end, "a piece ends within its planned interval");
  body.piece.end = next.begin;
  announce_end(body.piece);
  begin(body, next);
}

void World::predict_touches(EntityId id, std::vector<TouchPrediction>& out) {
  const Body& mine = body(id);
  const Box reach = mine.piece.planned_box.grown(kTouch_m);
  for (const std::uint32_t i : company_.near(id)) {
    const Body& other = bodies_[i];
    const EntityId other_id{i};
    if (!reach.overlaps(other.piece.planned_box) || have_touched(id, other_id)) continue;
    const Interval common{std::max(mine.piece.begin, other.piece.begin),
                          std::min({mine.piece.end, other.piece.end, kStart + scenario_.horizon})};
    if (common.begin > common.end || !near_part(mine.piece, other.piece, common, kTouch_m)) continue;
    if (const auto at = first_below(mine.piece, other.piece, common, kTouch_m, evaluations_)) {
      out.push_back({*at, id, other_id, mine.piece.number, other.piece.number});
    }
  }
}

void World::remember_touch(EntityId a, EntityId b) {
  touched_[a.index()].push_back(b);
  touched_[b.index()].push_back(a);
}

bool World::have_touched(EntityId a, EntityId b) const {
  return std::ranges::find(touched_[a.index()], b) != touched_[a.index()].end();
}

void World::forget_touches(EntityId id) {
  for (const EntityId other : touched_[id.index()]) std::erase(touched_[other.index()], id);
  touched_[id.index()].clear();
}

void World::finish(SimTime end) {
  for (Body& body : bodies_) {
    if (!body.on_floor) continue;
    body.piece.end = std::min(body.piece.end, end);
    announce_end(body.piece);
    company_.leaves(body.piece.entity);
  }
  for (const auto& law : laws_) law->finish(end);
}

LoadId World::add_load(TransportId transport, AgvId carrier, StationId at, StationId destination) {
  const LoadId load{loads_.size()};
  const bool is_open = !carrier.valid();
  loads_.push_back({transport, carrier, {Holder::Kind::Station, at.value}, destination, is_open});
  (is_open ? open_loads_ : loads_of_[carrier.index()]).push_back(load);
  if (load_of_.size() <= transport.index()) load_of_.resize(transport.index() + 1);
  load_of_[transport.index()] = load;
  return load;
}

void World::move_load(LoadId id, Holder to) {
  Load& load = loads_[id.index()];
  if (load.holder.kind == Holder::Kind::Agv) carried_[load.holder.index] = {};
  load.holder = to;
  if (to.kind == Holder::Kind::Agv) {
    carried_[to.index] = id;
    load.was_taken_up = true;
  }
  if (load.is_open && !load.is_delivered()) load.carrier = to.kind == Holder::Kind::Agv ? AgvId{to.index} : AgvId{};
}

LoadId World::waiting_load(AgvId agv, StationId station) const {
  for (const auto* loads : {&loads_of_[agv.index()], &open_loads_}) {
    const auto found = std::ranges::find_if(*loads, [&](LoadId load) { return is_waiting(load, agv, station); });
    if (found != loads->end()) return *found;
  }
  return {};
}

bool World::is_waiting(LoadId id, AgvId agv, StationId station) const {
  const Load& load = loads_[id.index()];
  return (load.carrier == agv || load.is_open) && load.holder == Holder{Holder::Kind::Station, station.value} &&
         load.destination != station;
}

LoadId World::load_of(TransportId transport) const {
  return transport.index() < load_of_.size() ? load_of_[transport.index()] : LoadId{};
}

}  // namespace fleetproof
