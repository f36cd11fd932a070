#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace fleetproof {

// The streams of randomness of a run. Each stream has its own key, so a further draw in one stream changes no other
// stream. `Factors` draws the continuous factors of a campaign, from the campaign's seed; a run has no such stream.
enum class Stream : std::uint32_t {
  Layout = 1,
  Placement,
  Transports,
  Motion,
  Radio,
  Faults,
  Agent,
  Factors,
  RadioState = 16,
  RadioCopy,
  RadioBackoff,
  RadioSources
};

// The streams of a run by their names: "layout", "placement", "transports", "motion", "radio", "faults", "agent".
inline constexpr std::array kRunStreams = {Stream::Layout, Stream::Placement, Stream::Transports, Stream::Motion,
                                           Stream::Radio,  Stream::Faults,    Stream::Agent};
const char* name_of(Stream stream);  // "radio" is the name of all streams of the radio
std::optional<Stream> stream_of_name(std::string_view name);

// A stream with a seed that differs from the seed of its world.
struct StreamSeed {
  Stream stream = Stream::Layout;  // one of kRunStreams
  std::uint64_t seed = 0;
  friend bool operator==(const StreamSeed&, const StreamSeed&) = default;
};

// Four 32-bit words, a pure function of key and counter (Philox4x32-10, Salmon et al. 2011).
using Block = std::array<std::uint32_t, 4>;
Block philox(std::uint64_t key, const Block& counter);
// What a key adds in each round, for `philox_of_four`: work out once what serves many draws.
class RoundKeys {
 public:
  explicit RoundKeys(std::uint64_t key);
  std::uint64_t key() const { return key_; }
  // Two numbers for each of ten rounds, each of them four times, in the lower halves of 64 bits.
  const std::uint64_t* numbers() const { return numbers_.data(); }

 private:
  std::uint64_t key_;
  std::array<std::uint64_t, 80> numbers_;
};
// The blocks of four counters that agree in their first two words; `rest`: their third word, and the fourth times 2^32.
// It costs less than half of four single blocks.
void philox_of_four(const RoundKeys& keys, std::uint64_t first_words, const std::uint64_t* rest, Block* blocks);
// Of the blocks of four such counters, whose last words have the bits of `common` set as well, one thing only: bit i
// says whether unit_interval(word64(block i, 0)) is below `limit` times 2^-53.
std::uint32_t philox_of_four_below(const RoundKeys& keys, std::uint64_t first_words, std::uint64_t common,
                                   const std::uint64_t* rest, std::uint64_t limit);

// The seed of a world: the same for every agent and every radio quality of a replicate (common random numbers).
// `world_factors` is a hash of what shapes the world (layout, fleet), never of agent or radio.
std::uint64_t world_seed(std::uint64_t campaign_seed, std::uint64_t replicate, std::uint64_t world_factors);

std::uint64_t stream_key(std::uint64_t world_seed, Stream stream);

// A 64-bit hash of a name that never changes. It is used for keys, not for lookups.
std::uint64_t name_hash(std::string_view name);

// [0, 1) with 53 bits.
constexpr double unit_interval(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1.0p-53; }
constexpr std::uint64_t word64(const Block& block, std::size_t half) {
  return (static_cast<std::uint64_t>(block[2 * half + 1]) << 32) | block[2 * half];
}

// A sequence of draws from (key, topic, item), for generators. The order of the draws is part of their definition.
class Draws {
 public:
  explicit Draws(std::uint64_t key, std::uint32_t topic = 0, std::uint32_t item = 0)
      : key_(key), topic_(topic), item_(item) {}

  std::uint64_t next();
  double uniform() { return unit_interval(next()); }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  std::uint32_t below(std::uint32_t bound);  // 0 .. bound-1, unbiased to 2^-32; bound >= 1
  double exponential(double mean);

 private:
  std::uint64_t key_;
  std::uint32_t topic_, item_;
  std::uint64_t drawn_ = 0;
};

// The natural logarithm of a positive normal number. It uses + - * / only, so that every CPU gives the same bits. The
// relative error is below 1e-15.
double natural_log(double x);

// e to the power of x, in the same way. The relative error is below 4e-16 for |x| <= 700. Beyond, the value at this
// limit is returned, so that the result is finite and positive.
double natural_exp(double x);

}  // namespace fleetproof
