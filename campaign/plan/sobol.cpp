#include "campaign/plan/sobol.hpp"

#include <boost/random/sobol.hpp>

#include "campaign/plan/unit_sample.hpp"

namespace fleetproof {

std::uint64_t sobol_bits(std::uint64_t index, std::uint32_t dimension) {
  // Boost has no element 0; with it, any 2^k elements from a multiple of 2^k on lie in 2^k strata
  if (index == 0) return 0;
  boost::random::sobol sequence(UnitSample::kDimensions);
  sequence.seed(index - 1);
  for (std::uint32_t before = 0; before < dimension; ++before) sequence();
  return sequence();
}

}  // namespace fleetproof
