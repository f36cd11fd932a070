#pragma once

#include <cstdint>
#include <vector>

#include "core/agents/hull.hpp"
#include "core/agents/map_view.hpp"

namespace fleetproof::agents {

// Where an AGV may stand for long. A standing AGV must keep clear of every lane that does not touch its station, and
// the other stations must still reach each other without its station. A station whose lanes are all one-way is a
// waiting place too: there the AGV only holds up those behind it. Each station is judged at the first question.
class WaitingPlaces {
 public:
  WaitingPlaces(const MapView& map, HullGeometry& geometry)
      : map_(map), geometry_(geometry), burdens_(map.station_count(), kUnknown) {}

  bool is_safe(std::uint32_t station) { return burden(station) == 0; }
  // How much an AGV that stands here blocks: the number of stations it cuts off, or kFoulsLanes and more if it blocks
  // lanes. 0: a safe place.
  std::uint32_t burden(std::uint32_t station);

  static constexpr std::uint32_t kFoulsLanes = 10'000;

 private:
  static constexpr std::uint32_t kUnknown = ~0U;

  bool leaves_lanes_clear(std::uint32_t station);
  bool is_dead_end(std::uint32_t station) const;
  std::uint32_t stations_cut_off(std::uint32_t station);
  // The number of stations that `from` reaches, and that reach `from`, without passing `without`.
  std::uint32_t strongly_connected_with(std::uint32_t from, std::uint32_t without);
  void mark_reachable(std::uint32_t from, std::uint32_t without, bool backwards);

  const MapView& map_;
  HullGeometry& geometry_;
  std::vector<std::uint32_t> burdens_;  // by station
  std::vector<std::uint8_t> marks_;     // by station: 1 reached, 2 reaches
  std::vector<std::uint32_t> stack_;
};

}  // namespace fleetproof::agents
