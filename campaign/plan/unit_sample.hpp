#pragma once

#include <cstdint>

#include "core/base/words.hpp"
#include "storage/factors.hpp"

namespace fleetproof {

// How the points of continuous factors are drawn.
// - Uniform: every replicate by itself. The draws are independent; exact binomial bounds hold for them.
// - LatinHypercube: of N planned replicates, each has a stratum of width 1/N to itself, in every dimension.
// - Sobol: a Sobol sequence under a random digital shift. Any 2^k replicates from a multiple of 2^k on have strata of
//   width 2^-k.
// In all three, every single point is uniform on the unit cube. The points of the last two cover the cube more evenly,
// but they are not independent of each other.
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

// One point of the unit cube for each replicate. The stream belongs to the campaign: no world, radio or agent draws
// from it. The point depends only on the arguments of the constructor, replicate and dimension, so runs can be drawn in
// any order. Threads: any number.
class UnitSample {
 public:
  static constexpr std::uint32_t kDimensions = kFactors.size();  // each factor has one, drawn or not

  // `replicates`: the size of a Latin hypercube, at least 1; after so many replicates the next hypercube begins. The
  // other samplings ignore it.
  UnitSample(Sampling sampling, std::uint64_t campaign_seed, std::uint64_t replicates);

  double at(std::uint64_t replicate, std::uint32_t dimension) const;  // [0, 1)

 private:
  double latin(std::uint64_t replicate, std::uint32_t dimension) const;

  Sampling sampling_;
  std::uint64_t key_, replicates_;
};

}  // namespace fleetproof
