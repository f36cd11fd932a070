#pragma once

#include <cstdint>
#include <optional>

#include "reports/evidence/confidence.hpp"

namespace fleetproof {

// Exact statements about a probability of failure, after `failing` of `units` independent trials failed.
// Requires: failing <= units, and a number of trials that was fixed beforehand.

struct RateInterval {
  double lower = 0.0;
  double upper = 1.0;
};

// Clopper and Pearson (1934): quantiles of Beta(failing, units - failing + 1) and Beta(failing + 1, units - failing).
// Two-sided: half of the risk on each side. One-sided: the whole risk on one side. Without trials, the interval is
// [0, 1].
RateInterval two_sided_interval(std::uint64_t failing, std::uint64_t units, Confidence confidence);
double lower_bound(std::uint64_t failing, std::uint64_t units, Confidence confidence);
double upper_bound(std::uint64_t failing, std::uint64_t units, Confidence confidence);

// The binomial probability of `failing` or fewer failures if each trial fails with probability p.
// Requires: 0 <= p <= 1.
double probability_of_at_most(std::uint64_t failing, std::uint64_t units, double p);

// The plan with acceptance number `failing`: the smallest number of trials for which that many failures or fewer have
// a probability of at most the risk if each trial fails with probability `limit`. Then the one-sided upper bound is at
// or below the limit. Absent if there is no such number (limit 0), or none below 10^15.
std::optional<std::uint64_t> units_needed(std::uint64_t failing, double limit, Confidence confidence);

}  // namespace fleetproof
