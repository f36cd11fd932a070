#pragma once

#include <cstdint>
#include <vector>

#include "core/agents/hull.hpp"
#include "core/agents/map_view.hpp"
#include "core/agents/place_judge.hpp"

namespace fleetproof::agents {

// Where an AGV may stand for long. Each station is judged at the first question, once for all AGVs of the run.
// Requires: map and geometry outlive the object.
class WaitingPlaces {
 public:
  WaitingPlaces(const MapView& map, const HullGeometry& geometry)
      : parts_(geometry.parts()), burdens_(map.station_count(), kUnknown) {}

  bool is_safe(std::uint32_t station) { return burden(station) == 0; }
  // How much an AGV that stands here blocks: see PlaceJudge.
  std::uint32_t burden(std::uint32_t station) {
    std::uint32_t& known = burdens_[station];
    if (known == kUnknown) known = burden_of(parts_, station);
    return known;
  }

 private:
  static constexpr std::uint32_t kUnknown = ~0U;

  const HullParts& parts_;
  std::vector<std::uint32_t> burdens_;  // by station
};

}  // namespace fleetproof::agents
