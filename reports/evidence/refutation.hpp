#pragma once

#include <cstdint>

#include "reports/evidence/confidence.hpp"

namespace fleetproof {

// Evidence that each trial fails with a probability above `limit`. Like the release gate, it may be read after every
// trial and stopped at any time: software at or below the limit is ever refuted with a probability of at most the risk
// (Ville 1939).
//
// For a probability q whose odds are c times those of the limit, the likelihood ratio is
// e_c = c^failing / (1 + (c - 1) limit)^units. Its expectation after each trial is at most what it was before, wherever
// the true probability is at or below the limit. The evidence is the mean over c = 2, 5 and 20, which is part of the
// method. It falls as the limit grows, so the limits that it does not refute form a confidence sequence.

// The natural logarithm of the mean. Requires: failing <= units, 0 <= limit < 1.
double log_refutation(std::uint64_t failing, std::uint64_t units, double limit);

// The largest limit that is refuted; 0 if none is. Requires: failing <= units.
double refuted_limit(std::uint64_t failing, std::uint64_t units, Confidence confidence);

}  // namespace fleetproof
