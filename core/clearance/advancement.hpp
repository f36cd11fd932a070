#pragma once

#include <optional>

#include "core/clearance/clearance_over_time.hpp"
#include "core/clearance/phase_motion.hpp"

namespace fleetproof {

struct Hit {
  SimTime at = kStart;
  Separation apart;
};

// Exact: the first instant, as exactly as first_below() says. Rough: an instant soon after it, for callers that only
// need to know whether there is one.
enum class Dating { Exact, Rough };

// Walks through time from `from` to `to`, forward or backward, by directional conservative advancement. Returns the
// first instant whose clearance is below `level_m`. At all instants before, the clearance is at or above the level,
// except for dips of less than a nanometre and, with exact dating, for the last nanosecond.
std::optional<Hit> advance(const Piece& a, const Piece& b, SimTime from, SimTime to, double level_m,
                           EvaluationCount& count, Dating dating = Dating::Exact);

// The same, from an instant that has been measured already. `lowest` becomes the lowest clearance on the way, if that
// is lower.
std::optional<Hit> advance(const Piece& a, const Piece& b, const Hit& from, SimTime to, double level_m,
                           EvaluationCount& count, Dating dating, Hit& lowest);

}  // namespace fleetproof
