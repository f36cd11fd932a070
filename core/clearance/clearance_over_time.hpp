// The clearance of two bodies over time: its first instant below a distance, and its least value.
#pragma once

#include <cstdint>
#include <optional>

#include "core/base/tolerances.hpp"
#include "core/motion/piece.hpp"

namespace fleetproof {

// A common interval of two pieces; both must cover it.
struct Interval {
  SimTime begin = kStart;
  SimTime end = kStart;
};

struct ClosestApproach {
  double clearance_m = 0.0;
  SimTime at = kStart;
};

// Distance evaluations spent: a cost that no machine changes.
struct EvaluationCount {
  std::uint64_t distance = 0;
};

// First instant in the interval at which the clearance is below `level_m`, by directional conservative advancement:
// with the direction of the closest points held fixed, the gap along it bounds the clearance from below, so the jump to
// where that bound meets the level skips nothing. The instant is exact to a microsecond (on straight lines 2 ns), or
// the clearance there is within 1 nm of the level. Dips of less than 1 nm below the level may go unreported.
std::optional<SimTime> first_below(const Piece& a, const Piece& b, Interval within, double level_m,
                                   EvaluationCount& count);

// Last such instant: first_below seen backwards in time.
std::optional<SimTime> last_below(const Piece& a, const Piece& b, Interval within, double level_m,
                                  EvaluationCount& count);

// An instant at which the clearance is below `level_m`, on the first dip below: first_below without the cost of the
// last nanoseconds.
std::optional<SimTime> comes_below(const Piece& a, const Piece& b, Interval within, double level_m,
                                   EvaluationCount& count);

// Smallest clearance over the interval, to `tolerance_m`, with an instant at which it is met; nothing if it stays at or
// above `below_m`. If the bodies touch, the first instant at which they do, with the clearance (zero or less) of that
// instant.
std::optional<ClosestApproach> closest_approach(const Piece& a, const Piece& b, Interval within, double below_m,
                                                EvaluationCount& count, double tolerance_m = kSmallestClearance_m);

// first_below and closest_approach in one: the search for the second begins where the walk to the first ends.
struct ApproachBelow {
  SimTime first = kStart;
  ClosestApproach closest;
};
std::optional<ApproachBelow> approach_below(const Piece& a, const Piece& b, Interval within, double level_m,
                                            EvaluationCount& count, double tolerance_m = kSmallestClearance_m);

}  // namespace fleetproof
