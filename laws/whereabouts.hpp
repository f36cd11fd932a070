#pragma once

#include <vector>

#include "core/law.hpp"

namespace fleetproof {

// An AGV stands at a station if its reference point is no farther from it.
inline constexpr double kAtStation_m = 0.05;

// What every body does at present, as announced.
class Whereabouts {
 public:
  explicit Whereabouts(const Scenario& scenario) : scenario_(scenario), current_(scenario.body_count()) {}

  void note(const Piece& piece) { current_[piece.entity.index()] = piece; }
  std::size_t agv_count() const { return scenario_.agvs.size(); }
  std::size_t body_count() const { return current_.size(); }
  const Piece& of(EntityId body) const { return current_[body.index()]; }
  bool moves(EntityId body) const { return of(body).manner != Manner::Rest; }
  Vec2 position_m(EntityId body, SimTime t) const { return of(body).pose_at(t).position_m; }
  bool stands_at(EntityId body, StationId station, SimTime t) const {
    if (moves(body) || station.index() >= scenario_.map->station_count()) return false;
    return (position_m(body, t) - scenario_.map->station(station).position_m).norm() <= kAtStation_m;
  }

 private:
  const Scenario& scenario_;
  std::vector<Piece> current_;
};

}  // namespace fleetproof
