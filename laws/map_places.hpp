#pragma once

#include <vector>

#include "core/scenario/layout.hpp"

namespace fleetproof {

// Places of a map at which AGVs get into each other's way. By station.
struct MapPlaces {
  explicit MapPlaces(const LogicalMap& map);

  // Without this station, a tenth of all stations is cut off from the others, whichever way lanes are driven.
  std::vector<bool> bottleneck;
  // Lanes from four other stations or more end here.
  std::vector<bool> four_way;
};

}  // namespace fleetproof
