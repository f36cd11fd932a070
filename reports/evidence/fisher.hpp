#pragma once

#include <cstdint>

namespace fleetproof {

// Fisher's exact test of two proportions, failing1 of units1 against failing2 of units2: given the margins, the
// failures in the first group are hypergeometric. Requires: failing1 <= units1, failing2 <= units2.
struct FisherResult {
  double two_sided = 1.0;      // the probability of all tables that are at most as likely as the observed one
  double first_smaller = 1.0;  // the probability of `failing1` or fewer failures in the first group
  double first_larger = 1.0;   // the probability of `failing1` or more failures in the first group
  double mid_two_sided = 1.0;  // `two_sided` without half of the observed table: not guaranteed, less conservative
};
FisherResult fisher_exact(std::uint64_t failing1, std::uint64_t units1, std::uint64_t failing2, std::uint64_t units2);

}  // namespace fleetproof
