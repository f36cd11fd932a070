#pragma once

#include <cstdint>

#include "core/base/words.hpp"
#include "storage/factors.hpp"

namespace fleetproof {

// How the points of continuous factors are drawn.
//   Uniform         every replicate by itself: independent draws, for which exact binomial bounds hold
//   LatinHypercube  of N planned replicates each has a stratum of width 1/N to itself, in every dimension
//   Sobol           a Sobol sequence under a random digital shift: any 2^k replicates from a multiple of 2^k on have a
//   stratum of width 2^-k each
// Every single point is uniform on the unit cube in all three. The last two cover it more evenly; their points are not
// independent of each other.
enum class Sampling : std::uint8_t { Uniform, LatinHypercube, Sobol };
constexpr const char* name_of(Sampling sampling) {
  switch (sampling) {
    case Sampling::Uniform:
      return "uniform";
    case Sampling::LatinHypercube:
      return "latin-hypercube";
    case Sampling::Sobol:
      return "sobol";
  }
  return kNoWord;
}
inline constexpr auto kSamplings = kValuesOf<Sampling>;

// One point of the unit cube for each replicate, from a stream of the campaign's own: no world, radio or agent draws
// from it. A pure function of what the constructor got, replicate and dimension, so that any run can be drawn first.
// Threads: any number.
class UnitSample {
 public:
  static constexpr std::uint32_t kDimensions = kFactors.size();  // each factor has one, drawn or not

  // `replicates`: the size of a Latin hypercube, at least 1; beyond it the next one begins. Of no account for the
  // others.
  UnitSample(Sampling sampling, std::uint64_t campaign_seed, std::uint64_t replicates);

  double at(std::uint64_t replicate, std::uint32_t dimension) const;  // [0, 1)

 private:
  double latin(std::uint64_t replicate, std::uint32_t dimension) const;

  Sampling sampling_;
  std::uint64_t key_, replicates_;
};

}  // namespace fleetproof
