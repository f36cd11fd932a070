#pragma once

#include <cstdint>

#include "reports/evidence/zero_failure.hpp"

namespace fleetproof {

// The runs that a results file held when its campaign went on. Somebody may have exchanged their rows in between: with
// good checksums, as those of other software.
struct TakenOver {
  std::uint64_t runs = 0;
  std::uint64_t simulated_again = 0;  // of them, before any other run; none came out otherwise and stayed untold
  std::uint64_t drawn = 0;            // of these at random; the others because something in the file spoke of them
  friend bool operator==(const TakenOver&, const TakenOver&) = default;
};

// If a larger share of the rows had been exchanged, one of those drawn would have been among them, with this
// confidence. 1 if none was drawn.
inline double most_exchanged(const TakenOver& taken, Confidence confidence) {
  return taken.drawn == 0 ? 1.0 : zero_failure_bound(taken.drawn, confidence);
}

}  // namespace fleetproof
