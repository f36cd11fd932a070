#pragma once

#include <cstdint>
#include <vector>

#include "core/base/tolerances.hpp"
#include "core/outcome/law.hpp"

namespace fleetproof {

// What every body on the floor does now, as the engine announced it. It points at pieces; none is copied.
class Whereabouts {
 public:
  explicit Whereabouts(const Scenario& scenario) : scenario_(scenario), bodies_(scenario.entity_count()) {}

  void note(const Piece& piece) { bodies_[piece.entity.index()] = {&piece, true, ++changes_}; }
  void note_leaving(EntityId body) {
    bodies_[body.index()].on_floor = false;
    ++changes_;
  }
  // As long as it stays the same, all pieces are the same.
  std::uint64_t changes() const { return changes_; }
  // The same for one body: each of its pieces has another number, above zero.
  std::uint64_t piece_number(EntityId body) const { return bodies_[body.index()].number; }
  bool on_floor(EntityId body) const { return bodies_[body.index()].on_floor; }
  std::size_t agv_count() const { return scenario_.agvs.size(); }
  std::size_t entity_count() const { return bodies_.size(); }
  // Requires: the body has been on the floor.
  const Piece& of(EntityId body) const { return *bodies_[body.index()].piece; }
  bool moves(EntityId body) const { return of(body).manner != Manner::Rest; }
  Vec2 position_m(EntityId body, SimTime t) const { return of(body).pose_at(t).position_m; }
  bool stands_at(EntityId body, StationId station, SimTime t) const {
    if (moves(body) || station.index() >= scenario_.map->station_count()) return false;
    return (position_m(body, t) - scenario_.map->station(station).position_m).norm() <= kAtStation_m;
  }

 private:
  const Scenario& scenario_;
  struct Body {
    const Piece* piece = nullptr;  // the last one
    bool on_floor = false;
    std::uint64_t number = 0;
  };
  std::vector<Body> bodies_;
  std::uint64_t changes_ = 0;
};

}  // namespace fleetproof
