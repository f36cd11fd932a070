#pragma once

#include <cstdint>
#include <optional>

namespace fleetproof {

// Exact statements about a probability of failure, after `failing` of `units` independent trials failed.
// Requires: failing <= units, 0 < confidence < 1, and a number of trials that was fixed beforehand.

struct Interval {
  double lower = 0.0;
  double upper = 1.0;
};

// Clopper-Pearson. Two-sided: half of the risk on each side. One-sided: the whole risk on one side. Without trials, the
// interval is [0, 1].
Interval two_sided_interval(std::uint64_t failing, std::uint64_t units, double confidence);
double lower_bound(std::uint64_t failing, std::uint64_t units, double confidence);
double upper_bound(std::uint64_t failing, std::uint64_t units, double confidence);

// The smallest number of trials whose one-sided upper bound is at or below `limit` if `failing` of them fail. Absent if
// there is no such number (limit 0), or none below 10^15.
std::optional<std::uint64_t> units_needed(std::uint64_t failing, double limit, double confidence);

// Fisher's exact test of two proportions, failing1 of units1 against failing2 of units2.
struct FisherResult {
  double two_sided = 1.0;      // the probability of all tables that are at most as likely as the observed one
  double first_smaller = 1.0;  // the probability of `failing1` or fewer failures in the first group
  double first_larger = 1.0;   // the probability of `failing1` or more failures in the first group
};
FisherResult fisher_exact(std::uint64_t failing1, std::uint64_t units1, std::uint64_t failing2, std::uint64_t units2);

}  // namespace fleetproof
