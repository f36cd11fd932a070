#pragma once

#include <cstdint>

namespace fleetproof {

// Element `index` of the Sobol sequence in dimension `dimension` (below UnitSample::kDimensions), as a fraction of
// 2^64. The elements are in the order of the Gray code; element 0 is 0. Direction numbers of Joe and Kuo (2008), from
// Boost.Random. A pure function. Throws nothing; index below 2^64 - 1.
std::uint64_t sobol_bits(std::uint64_t index, std::uint32_t dimension);

}  // namespace fleetproof
