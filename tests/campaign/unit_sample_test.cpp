#include "campaign/plan/unit_sample.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "campaign/plan/sobol.hpp"

namespace fleetproof::unit_sample_test {
namespace {

class Samples : public testing::TestWithParam<Sampling> {};
INSTANTIATE_TEST_SUITE_P(All, Samples, testing::ValuesIn(kSamplings), [](const auto& test) {
  std::string name = name_of(test.param);
  std::erase(name, '-');
  return name;
});

// Chi-square of counts that should be equal, in standard deviations from its mean.
double excess(const std::vector<int>& counts) {
  double all = 0.0, chi = 0.0;
  for (const int count : counts) all += count;
  const double expected = all / static_cast<double>(counts.size()), degrees = static_cast<double>(counts.size()) - 1.0;
  for (const int count : counts) chi += (count - expected) * (count - expected) / expected;
  return (chi - degrees) / std::sqrt(2.0 * degrees);
}

TEST_P(Samples, APointIsAFunctionOfItsIndexWhateverWasDrawnBefore) {
  constexpr std::uint64_t kPoints = 300;
  const UnitSample forwards(GetParam(), 5, kPoints);
  std::vector<double> first;
  for (std::uint64_t i = 0; i < kPoints; ++i) {
    for (std::uint32_t d = 0; d < UnitSample::kDimensions; ++d) first.push_back(forwards.at(i, d));
  }
  for (std::uint64_t i = kPoints; i-- > 0;) {
    const UnitSample alone(GetParam(), 5, kPoints);
    for (std::uint32_t d = UnitSample::kDimensions; d-- > 0;)
      EXPECT_EQ(alone.at(i, d), first[i * UnitSample::kDimensions + d]);
  }
  EXPECT_TRUE(std::ranges::all_of(first, [](double x) { return x >= 0.0 && x < 1.0; }));
  EXPECT_EQ(std::set<double>(first.begin(), first.end()).size(), first.size());
  EXPECT_NE(UnitSample(GetParam(), 6, kPoints).at(7, 0), forwards.at(7, 0))
      << "another campaign seed draws other points";
}

// Over campaign seeds every single point is uniform and its coordinates are independent: an estimate is unbiased
// whatever the way of drawing.
TEST_P(Samples, EveryPointIsUniformOverCampaignSeeds) {
  for (const std::uint64_t replicate : {0U, 1U, 5U, 6U}) {
    std::vector<int> cells(std::size_t{1} << (2 * UnitSample::kDimensions));  // a quarter of every side
    for (std::uint64_t seed = 0; seed < 12'800; ++seed) {
      const UnitSample sample(GetParam(), seed, 7);
      std::size_t cell = 0;
      for (std::uint32_t d = 0; d < UnitSample::kDimensions; ++d)
        cell = 4 * cell + static_cast<std::size_t>(4.0 * sample.at(replicate, d));
      ++cells[cell];
    }
    EXPECT_LT(std::abs(excess(cells)), 4.0) << replicate;
  }
}

TEST_P(Samples, TheSampleOfOneCampaignIsUniform) {
  const UnitSample sample(GetParam(), 42, 20'000);
  std::vector<int> cells(std::size_t{1} << (3 * UnitSample::kDimensions));  // an eighth of every side
  for (std::uint64_t i = 0; i < 20'000; ++i) {
    std::size_t cell = 0;
    for (std::uint32_t d = 0; d < UnitSample::kDimensions; ++d)
      cell = 8 * cell + static_cast<std::size_t>(8.0 * sample.at(i, d));
    ++cells[cell];
  }
  EXPECT_LT(excess(cells), 4.0);
}

TEST(UniformSample, NeighboursInTimeAreIndependent) {
  const UnitSample sample(Sampling::Uniform, 42, 1);
  std::vector<int> cells(10 * 10);
  for (std::uint64_t i = 0; i < 40'000; i += 2)
    ++cells[10 * static_cast<std::size_t>(10.0 * sample.at(i, 0)) +
            static_cast<std::size_t>(10.0 * sample.at(i + 1, 0))];
  EXPECT_LT(std::abs(excess(cells)), 4.0);
}

TEST(LatinHypercube, HasOnePointInEachStratumOfEveryDimension) {
  for (const std::uint64_t n : {1U, 2U, 3U, 7U, 16U, 17U, 100U, 1000U, 4097U}) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      const UnitSample sample(Sampling::LatinHypercube, seed, n);
      for (std::uint32_t d = 0; d < UnitSample::kDimensions; ++d) {
        for (const std::uint64_t block : {0U, 1U, 5U}) {
          std::set<std::uint64_t> strata;
          for (std::uint64_t i = block * n; i < (block + 1) * n; ++i)
            strata.insert(static_cast<std::uint64_t>(sample.at(i, d) * static_cast<double>(n)));
          EXPECT_EQ(strata.size(), n) << n << " " << seed << " " << d << " " << block;
          EXPECT_EQ(*strata.rbegin(), n - 1);
        }
      }
    }
  }
}

// All six orders of three strata, about equally often.
TEST(LatinHypercube, EveryPermutationOfASmallSampleComes) {
  std::vector<int> orders(27);
  for (std::uint64_t seed = 0; seed < 6000; ++seed) {
    const UnitSample sample(Sampling::LatinHypercube, seed, 3);
    std::size_t order = 0;
    for (std::uint64_t i = 0; i < 3; ++i) order = 3 * order + static_cast<std::size_t>(3.0 * sample.at(i, 1));
    ++orders[order];
  }
  std::erase(orders, 0);
  ASSERT_EQ(orders.size(), 6U);
  for (const int count : orders) EXPECT_NEAR(count, 1000, 250);
}

std::uint64_t reversed(std::uint64_t bits) {
  std::uint64_t result = 0;
  for (int i = 0; i < 64; ++i) result |= ((bits >> i) & 1) << (63 - i);
  return result;
}

TEST(SobolSequence, TheFirstDimensionIsVanDerCorputInGrayCode) {
  for (const std::uint64_t i : {0ULL, 1ULL, 2ULL, 3ULL, 100ULL, 65'535ULL, 123'456'789'012ULL})
    EXPECT_EQ(sobol_bits(i, 0), reversed(i ^ (i >> 1))) << i;
}

// The first points of Joe and Kuo's program for three dimensions.
TEST(SobolSequence, BeginsAsPublished) {
  constexpr double kPublished[8][3] = {{0, 0, 0},
                                       {0.5, 0.5, 0.5},
                                       {0.75, 0.25, 0.25},
                                       {0.25, 0.75, 0.75},
                                       {0.375, 0.375, 0.625},
                                       {0.875, 0.875, 0.125},
                                       {0.625, 0.125, 0.875},
                                       {0.125, 0.625, 0.375}};
  for (std::uint64_t i = 0; i < 8; ++i) {
    for (std::uint32_t d = 0; d < 3; ++d)
      EXPECT_EQ(static_cast<double>(sobol_bits(i, d)) * 0x1.0p-64, kPublished[i][d]) << i << " " << d;
  }
}

// A net in base 2: any 256 points from a multiple of 256 on have one in each box of 2^-a by 2^-(8-a), shifted or not.
TEST(SobolSample, HasOnePointInEachElementaryBox) {
  const UnitSample sample(Sampling::Sobol, 9, 1);
  for (const std::uint64_t start : {0U, 256U, 2560U}) {
    for (std::uint32_t a = 0; a <= 8; ++a) {
      std::set<std::pair<int, int>> boxes;
      for (std::uint64_t i = start; i < start + 256; ++i) {
        boxes.emplace(static_cast<int>(sample.at(i, 0) * (1 << a)), static_cast<int>(sample.at(i, 1) * (1 << (8 - a))));
      }
      EXPECT_EQ(boxes.size(), 256U) << a;
    }
  }
}

// The L2 star discrepancy by Warnock's formula.
double discrepancy(const UnitSample& sample, std::uint64_t points) {
  const auto n = static_cast<double>(points);
  double mixed = 0.0, pairs = 0.0;
  for (std::uint64_t i = 0; i < points; ++i) {
    double product = 1.0;
    for (std::uint32_t d = 0; d < 3; ++d) product *= (1.0 - sample.at(i, d) * sample.at(i, d)) / 2.0;
    mixed += product;
    for (std::uint64_t j = 0; j < points; ++j) {
      product = 1.0;
      for (std::uint32_t d = 0; d < 3; ++d) product *= 1.0 - std::max(sample.at(i, d), sample.at(j, d));
      pairs += product;
    }
  }
  return std::sqrt(1.0 / 27.0 - 2.0 / n * mixed + pairs / (n * n));
}

TEST(SobolSample, CoversMoreEvenlyThanIndependentDraws) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const double sobol = discrepancy(UnitSample(Sampling::Sobol, seed, 1), 200),
                 uniform = discrepancy(UnitSample(Sampling::Uniform, seed, 1), 200);
    EXPECT_LT(sobol, 0.5 * uniform) << seed;
  }
}

}  // namespace
}  // namespace fleetproof::unit_sample_test
