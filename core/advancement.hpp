#pragma once

#include <optional>

#include "core/clearance_over_time.hpp"
#include "core/phase_motion.hpp"

namespace fleetproof {

struct Hit {
  SimTime at = kStart;
  double clearance_m = 0.0;
};

// Walks time from `from` to `to`, forward or backward, by directional conservative advancement; the first instant met whose clearance is below
// `level_m`. Everything walked over before it is at or above the level, but for dips of less than a nanometre and the one nanosecond before it.
std::optional<Hit> advance(const Piece& a, const Piece& b, SimTime from, SimTime to, double level_m, EvaluationCount& count);

}  // namespace fleetproof
