#pragma once

#include <optional>

#include "core/clearance/clearance_over_time.hpp"
#include "core/clearance/phase_motion.hpp"

namespace fleetproof {

struct Hit {
  SimTime at = kStart;
  Separation apart;
};

// Exact: the first instant, to one nanosecond. Rough: some instant soon after it, for who only wants to know whether
// there is one.
enum class Dating { Exact, Rough };

// Walks time from `from` to `to`, forward or backward, by directional conservative advancement; the first instant met
// whose clearance is below `level_m`. Everything walked over before it is at or above the level, but for dips of less
// than a nanometre and (with exact dating) the one nanosecond before it.
std::optional<Hit> advance(const Piece& a, const Piece& b, SimTime from, SimTime to, double level_m,
                           EvaluationCount& count, Dating dating = Dating::Exact);

// The same from an instant that is measured already. The lowest clearance met on the way goes to `lowest`, which stays
// if it is lower.
std::optional<Hit> advance(const Piece& a, const Piece& b, const Hit& from, SimTime to, double level_m,
                           EvaluationCount& count, Dating dating, Hit& lowest);

}  // namespace fleetproof
