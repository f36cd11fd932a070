#include "core/base/random.hpp"

#include <Random123/philox.h>
#ifdef __x86_64__
#include <immintrin.h>
#endif

#include <algorithm>
#include <bit>

#include "core/base/error.hpp"

namespace fleetproof {

Block philox(std::uint64_t key, const Block& counter) {
  const r123::Philox4x32::ctr_type ctr = {{counter[0], counter[1], counter[2], counter[3]}};
  const r123::Philox4x32::key_type k = {{static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(key >> 32)}};
  const auto out = r123::Philox4x32{}(ctr, k);
  return {out[0], out[1], out[2], out[3]};
}

RoundKeys::RoundKeys(std::uint64_t key) : key_(key) {
  auto key0 = static_cast<std::uint32_t>(key), key1 = static_cast<std::uint32_t>(key >> 32);
  for (std::size_t i = 0; i < numbers_.size(); i += 8, key0 += PHILOX_W32_0, key1 += PHILOX_W32_1) {
    std::fill_n(numbers_.begin() + static_cast<std::ptrdiff_t>(i), 4, key0);
    std::fill_n(numbers_.begin() + static_cast<std::ptrdiff_t>(i + 4), 4, key1);
  }
}

// ---- four counters at once: each way gives the same numbers

namespace {

#ifdef __x86_64__

// Two counters: each word of both in the lower halves of two lanes. What the upper halves hold does not matter.
struct TwoCounters {
  __m128i word0, word1, word2, word3;

  TwoCounters(const std::uint64_t* keys, std::uint64_t first_words, const std::uint64_t* rest)
      : word0(_mm_set1_epi32(static_cast<std::int32_t>(first_words))),
        word1(_mm_set1_epi32(static_cast<std::int32_t>(first_words >> 32))),
        word2(_mm_loadu_si128(reinterpret_cast<const __m128i*>(rest))),
        word3(_mm_srli_epi64(word2, 32)) {
    for (int i = 0; i < PHILOX4x32_DEFAULT_ROUNDS; ++i, keys += 8) {
      const __m128i product0 = _mm_mul_epu32(word0, _mm_set1_epi64x(PHILOX_M4x32_0));
      const __m128i product1 = _mm_mul_epu32(word2, _mm_set1_epi64x(PHILOX_M4x32_1));
      const __m128i key0 = _mm_loadu_si128(reinterpret_cast<const __m128i*>(keys)),
                    key1 = _mm_loadu_si128(reinterpret_cast<const __m128i*>(keys + 4));
      word0 = _mm_xor_si128(_mm_xor_si128(_mm_srli_epi64(product1, 32), word1), key0);
      word2 = _mm_xor_si128(_mm_xor_si128(_mm_srli_epi64(product0, 32), word3), key1);
      word1 = product1;
      word3 = product0;
    }
  }

  void store(Block& first, Block& second) const {
    const __m128i of_first01 = _mm_unpacklo_epi32(word0, word1), of_first23 = _mm_unpacklo_epi32(word2, word3);
    const __m128i of_second01 = _mm_unpackhi_epi32(word0, word1), of_second23 = _mm_unpackhi_epi32(word2, word3);
    _mm_storeu_si128(reinterpret_cast<__m128i*>(first.data()), _mm_unpacklo_epi64(of_first01, of_first23));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(second.data()), _mm_unpacklo_epi64(of_second01, of_second23));
  }
};

// The same for four counters, if the processor can do that.
[[gnu::target("avx2")]] std::uint32_t four_below_at_once(const std::uint64_t* keys, std::uint64_t first_words,
                                                         std::uint64_t common, const std::uint64_t* rest,
                                                         std::uint64_t limit) {
  __m256i word0 = _mm256_set1_epi32(static_cast<std::int32_t>(first_words)),
          word1 = _mm256_set1_epi32(static_cast<std::int32_t>(first_words >> 32)),
          word2 = _mm256_or_si256(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(rest)),
                                  _mm256_set1_epi64x(static_cast<std::int64_t>(common))),
          word3 = _mm256_srli_epi64(word2, 32);
#pragma GCC unroll 10
  for (int i = 0; i < PHILOX4x32_DEFAULT_ROUNDS; ++i, keys += 8) {
    const __m256i product0 = _mm256_mul_epu32(word0, _mm256_set1_epi64x(PHILOX_M4x32_0));
    const __m256i product1 = _mm256_mul_epu32(word2, _mm256_set1_epi64x(PHILOX_M4x32_1));
    const __m256i key0 = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(keys)),
                  key1 = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(keys + 4));
    word0 = _mm256_xor_si256(_mm256_xor_si256(_mm256_srli_epi64(product1, 32), word1), key0);
    word2 = _mm256_xor_si256(_mm256_xor_si256(_mm256_srli_epi64(product0, 32), word3), key1);
    word1 = product1;
    word3 = product0;
  }
  const __m256i bits = _mm256_blend_epi32(word0, _mm256_slli_epi64(word1, 32), 0b10101010);
  const __m256i below =
      _mm256_cmpgt_epi64(_mm256_set1_epi64x(static_cast<std::int64_t>(limit)), _mm256_srli_epi64(bits, 11));
  return static_cast<std::uint32_t>(_mm256_movemask_pd(_mm256_castsi256_pd(below)));
}

#endif

}  // namespace

void philox_of_four(const RoundKeys& keys, std::uint64_t first_words, const std::uint64_t* rest, Block* blocks) {
#ifdef __x86_64__
  TwoCounters(keys.numbers(), first_words, rest).store(blocks[0], blocks[1]);
  TwoCounters(keys.numbers(), first_words, rest + 2).store(blocks[2], blocks[3]);
#else
  for (int i = 0; i < 4; ++i) {
    blocks[i] =
        philox(keys.key(), {static_cast<std::uint32_t>(first_words), static_cast<std::uint32_t>(first_words >> 32),
                            static_cast<std::uint32_t>(rest[i]), static_cast<std::uint32_t>(rest[i] >> 32)});
  }
#endif
}

std::uint32_t philox_of_four_below(const RoundKeys& keys, std::uint64_t first_words, std::uint64_t common,
                                   const std::uint64_t* rest, std::uint64_t limit) {
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2")) return four_below_at_once(keys.numbers(), first_words, common, rest, limit);
#endif
  const std::array<std::uint64_t, 4> whole = {rest[0] | common, rest[1] | common, rest[2] | common, rest[3] | common};
  std::array<Block, 4> blocks;
  philox_of_four(keys, first_words, whole.data(), blocks.data());
  std::uint32_t below = 0;
  for (std::size_t i = 0; i < blocks.size(); ++i) below |= (word64(blocks[i], 0) >> 11 < limit ? 1U : 0U) << i;
  return below;
}

namespace {

std::uint64_t mix(std::uint64_t key, std::uint64_t value, std::uint32_t domain) {
  return word64(philox(key, {static_cast<std::uint32_t>(value), static_cast<std::uint32_t>(value >> 32), domain, 0}),
                0);
}

// Domains keep the two uses of `mix` apart: a replicate number never collides with a stream number.
constexpr std::uint32_t kReplicateDomain = 0x52455031, kFactorsDomain = 0x46414331, kStreamDomain = 0x53545231;

}  // namespace

std::uint64_t world_seed(std::uint64_t campaign_seed, std::uint64_t replicate, std::uint64_t world_factors) {
  return mix(mix(campaign_seed, replicate, kReplicateDomain), world_factors, kFactorsDomain);
}

std::uint64_t stream_key(std::uint64_t world_seed, Stream stream) {
  return mix(world_seed, static_cast<std::uint64_t>(stream), kStreamDomain);
}

const char* name_of(Stream stream) {
  switch (stream) {
    case Stream::Layout:
      return "layout";
    case Stream::Placement:
      return "placement";
    case Stream::Transports:
      return "transports";
    case Stream::Motion:
      return "motion";
    case Stream::Faults:
      return "faults";
    case Stream::Agent:
      return "agent";
    case Stream::Factors:
      return "factors";
    case Stream::Radio:
    case Stream::RadioState:
    case Stream::RadioCopy:
    case Stream::RadioBackoff:
    case Stream::RadioSources:
      return "radio";
  }
  invariant_violated("a stream has a name");
}

std::optional<Stream> stream_of_name(std::string_view name) {
  for (const Stream stream : kRunStreams) {
    if (name == name_of(stream)) return stream;
  }
  return std::nullopt;
}

std::uint64_t name_hash(std::string_view name) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;  // FNV-1a
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return hash;
}

std::uint64_t Draws::next() {
  const auto block =
      philox(key_, {static_cast<std::uint32_t>(drawn_), static_cast<std::uint32_t>(drawn_ >> 32), topic_, item_});
  ++drawn_;
  return word64(block, 0);
}

std::uint32_t Draws::below(std::uint32_t bound) {
  return static_cast<std::uint32_t>(((next() >> 32) * static_cast<std::uint64_t>(bound)) >> 32);
}

double Draws::exponential(double mean) { return -mean * natural_log(1.0 - uniform()); }

double natural_log(double x) {
  const auto bits = std::bit_cast<std::uint64_t>(x);
  int exponent = static_cast<int>(bits >> 52) - 1023;
  double mantissa = std::bit_cast<double>((bits & 0x000fffffffffffffULL) | 0x3ff0000000000000ULL);
  if (mantissa > 1.4142135623730951) {
    mantissa *= 0.5;
    ++exponent;
  }
  // ln m = 2 artanh((m-1)/(m+1)), |argument| <= 0.172: eleven terms reach 1e-17.
  const double z = (mantissa - 1.0) / (mantissa + 1.0), z2 = z * z;
  double sum = 0.0;
  for (int k = 21; k >= 1; k -= 2) sum = sum * z2 + 1.0 / k;
  return static_cast<double>(exponent) * 0.6931471805599453 + 2.0 * z * sum;
}

double natural_exp(double x) {
  constexpr double kLimit = 700.0;
  x = std::clamp(x, -kLimit, kLimit);
  const double scaled = x * 1.4426950408889634;  // 1 / ln 2
  const int exponent = static_cast<int>(scaled < 0.0 ? scaled - 0.5 : scaled + 0.5);
  // ln 2 in two parts: the first has 32 bits, so that its product with the exponent is exact.
  const double rest = (x - exponent * 0x1.62e42feep-1) - exponent * 0x1.a39ef35793c76p-33;
  // The series of e^rest, |rest| <= 0.347: fourteen terms reach 1e-17.
  double sum = 0.0;
  for (int k = 14; k >= 1; --k) sum = (sum + 1.0) * rest / k;
  return (1.0 + sum) * std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52);
}

}  // namespace fleetproof
