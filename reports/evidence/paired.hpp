#pragma once

#include <cstdint>

#include "reports/evidence/binomial.hpp"

namespace fleetproof {

// Two releases on common seeds: how many pairs of runs fail in both, in the old release only, in the new release only,
// or in neither. The statements hold however well the pairs are matched.
struct PairedCounts {
  std::uint64_t both = 0, only_old = 0, only_new = 0, neither = 0;
  std::uint64_t pairs() const { return both + only_old + only_new + neither; }
};

// McNemar's exact test: of the pairs that differ, the number that fail in the new release only is Binomial(1/2) if the
// releases are equal.
struct McNemarResult {
  double two_sided = 1.0;      // min(1, 2 P(X <= the smaller count))
  double mid_two_sided = 1.0;  // `two_sided` without P(X = the smaller count); 1 if both counts are equal
  double new_worse = 1.0;      // one-sided: P(X >= only_new)
};
McNemarResult mcnemar_exact(std::uint64_t only_old, std::uint64_t only_new);

// The difference of the probabilities of failure, new minus old, with a guaranteed interval: the one-sided
// Clopper-Pearson bounds of both parts at a quarter of the risk each, upper(only_new) - lower(only_old) and its
// counterpart (Bonferroni). The one-sided upper bound takes half of the risk each. Requires: at least one pair.
struct PairedDifference {
  double difference = 0.0;
  double lower = -1.0, upper = 1.0;
  double one_sided_upper = 1.0;
};
PairedDifference paired_difference(const PairedCounts& counts, Confidence confidence);

}  // namespace fleetproof
