#include "core/base/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace fleetproof::random_test {
namespace {

TEST(Philox, KnownAnswers) {  // from the Random123 distribution's kat_vectors, philox4x32-10
  EXPECT_EQ(philox(0, {0, 0, 0, 0}), (Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox(~0ULL, {~0U, ~0U, ~0U, ~0U}), (Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox(0x299f31d0a4093822ULL, {0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}),
            (Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Philox, FourAtOnceAreTheSameAsOneByOne) {
  for (std::uint64_t round = 0; round < 1000; ++round) {
    const std::uint64_t key = word64(philox(1, {static_cast<std::uint32_t>(round)}), 0);
    const std::uint64_t first = word64(philox(2, {static_cast<std::uint32_t>(round)}), 0);
    std::array<std::uint64_t, 4> rest{};
    for (std::uint32_t i = 0; i < 4; ++i) rest[i] = word64(philox(key, {i}), 1);
    std::array<Block, 4> blocks{};
    const RoundKeys keys(key);
    philox_of_four(keys, first, rest.data(), blocks.data());
    for (std::size_t i = 0; i < 4; ++i) {
      const Block counter{static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(first >> 32),
                          static_cast<std::uint32_t>(rest[i]), static_cast<std::uint32_t>(rest[i] >> 32)};
      ASSERT_EQ(blocks[i], philox(key, counter)) << round << " " << i;
    }
  }
}

TEST(Philox, FourBelowALimitAreThoseWhoseNumbersAreBelowIt) {
  Draws draws(9);
  for (int round = 0; round < 1000; ++round) {
    const RoundKeys keys(draws.next());
    const std::uint64_t first = draws.next(), common = draws.next();
    std::array<std::uint64_t, 4> rest{}, whole{};
    for (std::size_t i = 0; i < 4; ++i) whole[i] = (rest[i] = draws.next()) | common;
    std::array<Block, 4> blocks{};
    philox_of_four(keys, first, whole.data(), blocks.data());
    const std::uint64_t of_first = word64(blocks[0], 0) >> 11;
    for (const std::uint64_t limit :
         {std::uint64_t{0}, std::uint64_t{1} << 53U, std::uint64_t{1} << 52U, of_first, of_first + 1}) {
      std::uint32_t below = 0;
      for (std::size_t i = 0; i < 4; ++i)
        below |= (unit_interval(word64(blocks[i], 0)) < static_cast<double>(limit) * 0x1p-53 ? 1U : 0U) << i;
      ASSERT_EQ(philox_of_four_below(keys, first, common, rest.data(), limit), below) << round << " " << limit;
    }
  }
}

TEST(Keys, DifferPerReplicateFactorsAndStream) {
  std::set<std::uint64_t> keys;
  for (std::uint64_t replicate = 0; replicate < 100; ++replicate) {
    for (std::uint64_t factors = 0; factors < 10; ++factors) {
      const auto seed = world_seed(1, replicate, factors);
      keys.insert(seed);
      for (const Stream stream : {Stream::Layout, Stream::Placement, Stream::Transports, Stream::Radio, Stream::Agent})
        keys.insert(stream_key(seed, stream));
    }
  }
  EXPECT_EQ(keys.size(), 100U * 10U * 6U);
}

TEST(NaturalLog, AgreesWithTheLibrary) {
  Draws draws(3);
  for (int i = 0; i < 100000; ++i) {
    const double x = std::ldexp(1.0 + draws.uniform(), static_cast<int>(draws.below(120)) - 60);
    EXPECT_NEAR(natural_log(x), std::log(x), 2e-15 * std::max(1.0, std::abs(std::log(x)))) << x;
  }
}

TEST(NaturalExp, AgreesWithTheLibrary) {
  Draws draws(4);
  for (int i = 0; i < 200000; ++i) {
    const double x = i % 2 == 0 ? draws.uniform(-700.0, 700.0) : draws.uniform(-2.0, 2.0);
    EXPECT_NEAR(natural_exp(x) / std::exp(x), 1.0, 4e-16) << x;
  }
  EXPECT_EQ(natural_exp(0.0), 1.0);
  EXPECT_EQ(natural_exp(1e9), natural_exp(700.0));
  EXPECT_GT(natural_exp(-1e9), 0.0);
}

TEST(Draws, HaveTheMomentsOfTheirDistribution) {
  Draws draws(5);
  double uniform = 0.0, exponential = 0.0;
  std::vector<int> faces(6);
  constexpr int n = 60000;
  for (int i = 0; i < n; ++i) {
    uniform += draws.uniform();
    exponential += draws.exponential(2.0);
    ++faces[draws.below(6)];
  }
  EXPECT_NEAR(uniform / n, 0.5, 6 * 0.289 / std::sqrt(n));
  EXPECT_NEAR(exponential / n, 2.0, 6 * 2.0 / std::sqrt(n));
  for (const int count : faces) EXPECT_NEAR(count, n / 6, 6 * std::sqrt(n * 5.0 / 36.0));
}

}  // namespace
}  // namespace fleetproof::random_test
