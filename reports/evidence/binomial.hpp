#pragma once

#include <cstdint>
#include <optional>

namespace fleetproof {

// Exact statements about a probability of failure after `failing` of `units` independent trials failed. All of them
// require failing <= units and 0 < confidence < 1, and hold for a number of trials that was fixed beforehand.

struct Interval {
  double lower = 0.0;
  double upper = 1.0;
};

// Clopper-Pearson. Two-sided: half of the risk on each side. One-sided: all of it on that side. Without trials: nothing
// is known, [0, 1].
Interval two_sided_interval(std::uint64_t failing, std::uint64_t units, double confidence);
double lower_bound(std::uint64_t failing, std::uint64_t units, double confidence);
double upper_bound(std::uint64_t failing, std::uint64_t units, double confidence);

// The smallest number of trials whose one-sided upper bound is at or below `limit` if `failing` of them fail. Absent if
// no number does (limit 0), or none below 10^15.
std::optional<std::uint64_t> units_needed(std::uint64_t failing, double limit, double confidence);

// Fisher's exact test of two proportions, failing1 of units1 against failing2 of units2.
struct FisherResult {
  double two_sided = 1.0;      // probability of all tables that are no likelier than the observed one
  double first_smaller = 1.0;  // of `failing1` or fewer in the first group
  double first_larger = 1.0;   // of `failing1` or more in the first group
};
FisherResult fisher_exact(std::uint64_t failing1, std::uint64_t units1, std::uint64_t failing2, std::uint64_t units2);

}  // namespace fleetproof
