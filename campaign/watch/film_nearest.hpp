#pragma once

#include <optional>

#include "campaign/watch/film_clearances.hpp"

namespace fleetproof {

// The smallest clearance of a run, and the two bodies that had it.
struct NearestPair {
  EntityId a, b;
  SimTime at;
  double clearance_m = 0.0;
};

// Of an AGV and any other body. Of equal clearances, that of the first pair counts, and its first instant. Nothing: no
// AGV was on the floor together with another body.
std::optional<NearestPair> nearest_pair(const PiecesOfBodies& bodies, std::size_t agv_count);

}  // namespace fleetproof
