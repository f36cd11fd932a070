#pragma once

#include <cstdint>
#include <vector>

#include "reports/evidence/confidence.hpp"

namespace fleetproof {

// One condition of an operational profile: its share of operation, and what was seen of it.
struct Stratum {
  double weight = 0.0;  // >= 0; the weights of a profile have the sum 1
  std::uint64_t units = 0, failing = 0;
};

// Upper bounds on the probability of failure over the profile, the weighted sum of those of the strata. A wrong
// profile voids them. Requires: at least one stratum; units fixed beforehand in each.

// Without failures, the exact bound (Buehler 1957): the largest weighted sum for which no failure at all still has a
// probability of the risk. Between strata with equal weight per unit it is the bound of the pooled units; strata
// with many units for little weight then add nothing. Requires: no failures.
double stratified_zero_failure_bound(const std::vector<Stratum>& strata, Confidence confidence);

// The weighted sum of the Clopper-Pearson bounds, each at its part of the risk (Bonferroni): conservative, and valid
// with failures.
double stratified_bound(const std::vector<Stratum>& strata, Confidence confidence);

// The Clopper-Pearson bound of all units together. It holds only if the units are divided as the weights are.
double pooled_bound(const std::vector<Stratum>& strata, Confidence confidence);

}  // namespace fleetproof
