#include "reports/evidence/paired.hpp"

#include <algorithm>

#include "core/base/error.hpp"
#include "reports/evidence/tail_sums.hpp"

namespace fleetproof {

McNemarResult mcnemar_exact(std::uint64_t only_old, std::uint64_t only_new) {
  const RatioLaw law = binomial_law(only_old + only_new, 1.0);
  const TailSums smaller = tail_sums(law, std::min(only_old, only_new));
  McNemarResult result;
  result.two_sided = std::min(1.0, 2.0 * smaller.at_most);
  if (only_old != only_new) result.mid_two_sided = 2.0 * smaller.at_most - smaller.exactly;
  result.new_worse = tail_sums(law, only_new).at_least;
  return result;
}

PairedDifference paired_difference(const PairedCounts& counts, Confidence confidence) {
  const std::uint64_t pairs = counts.pairs();
  ensure(pairs > 0, "a difference needs pairs");
  const Confidence half = confidence.shared(2.0), quarter = confidence.shared(4.0);
  PairedDifference result;
  result.difference =
      (static_cast<double>(counts.only_new) - static_cast<double>(counts.only_old)) / static_cast<double>(pairs);
  result.lower = lower_bound(counts.only_new, pairs, quarter) - upper_bound(counts.only_old, pairs, quarter);
  result.upper = upper_bound(counts.only_new, pairs, quarter) - lower_bound(counts.only_old, pairs, quarter);
  result.one_sided_upper = upper_bound(counts.only_new, pairs, half) - lower_bound(counts.only_old, pairs, half);
  return result;
}

}  // namespace fleetproof
