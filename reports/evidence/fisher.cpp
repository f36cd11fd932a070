#include "reports/evidence/fisher.hpp"

#include "core/base/error.hpp"
#include "reports/evidence/tail_sums.hpp"

namespace fleetproof {

FisherResult fisher_exact(std::uint64_t failing1, std::uint64_t units1, std::uint64_t failing2, std::uint64_t units2) {
  ensure(failing1 <= units1 && failing2 <= units2, "no more trials fail than there are");
  const TailSums sums = tail_sums(hypergeometric_law(units1, units2, failing1 + failing2), failing1);
  return {sums.no_likelier, sums.at_most, sums.at_least, sums.no_likelier - sums.exactly / 2.0};
}

}  // namespace fleetproof
