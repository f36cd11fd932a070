#include "campaign/plan/unit_sample.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "campaign/plan/sobol.hpp"
#include "core/base/error.hpp"
#include "core/base/random.hpp"

namespace fleetproof {
namespace {

// The kinds of draws: the third word of the counter. The fourth word is the dimension.
constexpr std::uint32_t kUniformTopic = 1, kWithinStratumTopic = 2, kRotationTopic = 3, kShiftTopic = 4,
                        kRoundTopic = 16;
constexpr std::uint32_t kRounds = 8;
constexpr double kBelowOne = 1.0 - 0x1.0p-53;

std::uint64_t draw(std::uint64_t key, std::uint64_t counter, std::uint32_t topic, std::uint32_t dimension) {
  return word64(
      philox(key, {static_cast<std::uint32_t>(counter), static_cast<std::uint32_t>(counter >> 32), topic, dimension}),
      0);
}

// The upper half of a product of 64 bits: bits * size / 2^64.
std::uint64_t scaled(std::uint64_t bits, std::uint64_t size) {
  __extension__ using Wide = unsigned __int128;
  return static_cast<std::uint64_t>((static_cast<Wide>(bits) * size) >> 64);
}

// A permutation of 0 .. size-1 that needs no memory. It is a Feistel network over the next power of four, repeated
// until the result is below the size. The rotation makes every image equally likely, even if the network mixes a small
// set badly.
class Permutation {
 public:
  Permutation(std::uint64_t key, std::uint64_t block, std::uint64_t size, std::uint32_t dimension)
      : key_(key),
        block_(block),
        size_(size),
        dimension_(dimension),
        half_bits_((static_cast<int>(std::bit_width(size - 1)) + 1) / 2) {}

  std::uint64_t at(std::uint64_t index) const {
    if (size_ == 1) return 0;
    do {
      index = network(index);
    } while (index >= size_);
    return (index + scaled(draw(key_, block_, kRotationTopic, dimension_), size_)) % size_;
  }

 private:
  std::uint64_t network(std::uint64_t value) const {
    const std::uint64_t mask = (std::uint64_t{1} << half_bits_) - 1;
    std::uint64_t left = value >> half_bits_, right = value & mask;
    for (std::uint32_t round = 0; round < kRounds; ++round) {
      const auto bits = draw(key_, (block_ << 32) | right, kRoundTopic + round, dimension_);
      left = std::exchange(right, left ^ (bits & mask));
    }
    return (left << half_bits_) | right;
  }

  std::uint64_t key_, block_, size_;
  std::uint32_t dimension_;
  int half_bits_;
};

}  // namespace

UnitSample::UnitSample(Sampling sampling, std::uint64_t campaign_seed, std::uint64_t replicates)
    : sampling_(sampling),
      key_(stream_key(campaign_seed, Stream::Factors)),
      replicates_(std::max<std::uint64_t>(1, replicates)) {}

double UnitSample::at(std::uint64_t replicate, std::uint32_t dimension) const {
  ensure(dimension < kDimensions, "a factor has a dimension of its own");
  switch (sampling_) {
    case Sampling::Uniform:
      return unit_interval(draw(key_, replicate, kUniformTopic, dimension));
    case Sampling::LatinHypercube:
      return latin(replicate, dimension);
    // One digital shift for all replicates. Unlike a shift modulo 1, it maps every dyadic stratum to a dyadic stratum.
    case Sampling::Sobol:
      return unit_interval(sobol_bits(replicate, dimension) ^ draw(key_, 0, kShiftTopic, dimension));
  }
  invariant_violated("a way of sampling is known");
}

double UnitSample::latin(std::uint64_t replicate, std::uint32_t dimension) const {
  const Permutation strata(key_, replicate / replicates_, replicates_, dimension);
  const auto stratum = static_cast<double>(strata.at(replicate % replicates_));
  const double within = unit_interval(draw(key_, replicate, kWithinStratumTopic, dimension));
  return std::min(kBelowOne, (stratum + within) / static_cast<double>(replicates_));
}

}  // namespace fleetproof
