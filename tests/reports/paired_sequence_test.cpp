// The rule of comparisons promises: however often one looks, a wrong claim is shown with a probability of the risk at
// most. The probability is computed exactly, from the definition alone.
#include "reports/evidence/paired_sequence.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace fleetproof::paired_sequence_test {
namespace {

constexpr int kWorlds = 250;
constexpr double kRisk = 0.05;

struct Claim {
  double sign, offset;
  std::array<double, 3> bets;
};
Claim not_worse_by(double margin) { return {-1.0, margin, {0.25, 0.5, 1.0}}; }
const Claim kWorse{1.0, 0.0, {0.25, 0.5, 0.9}}, kImproved{-1.0, 0.0, {0.25, 0.5, 0.9}};

// The mean of the three products after so many worlds of each kind.
double money(const Claim& claim, int up, int same, int down) {
  double sum = 0.0;
  for (const double bet : claim.bets) {
    const auto factor = [&](double value) { return 1.0 + bet * (claim.sign * value + claim.offset); };
    sum += std::pow(factor(1.0), up) * std::pow(factor(0.0), same) * std::pow(factor(-1.0), down);
  }
  return sum / 3.0;
}

// The probability that the claim is shown at some time, if a world goes up or down with these probabilities.
double probability_of_showing(const Claim& claim, double up, double down) {
  std::vector<std::vector<double>> now(kWorlds + 1, std::vector<double>(kWorlds + 1));  // [ups][downs]
  now[0][0] = 1.0;
  double shown = 0.0;
  for (int n = 1; n <= kWorlds; ++n) {
    auto next = std::vector<std::vector<double>>(kWorlds + 1, std::vector<double>(kWorlds + 1));
    for (int i = 0; i < n; ++i) {
      for (int j = 0; i + j < n; ++j) {
        const double p = now[i][j];
        if (p == 0.0) continue;
        next[i + 1][j] += p * up;
        next[i][j + 1] += p * down;
        next[i][j] += p * (1.0 - up - down);
      }
    }
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; i + j <= n; ++j) {
        if (next[i][j] == 0.0 || money(claim, i, n - i - j, j) < 1.0 / kRisk) continue;
        shown += next[i][j];
        next[i][j] = 0.0;
      }
    }
    now.swap(next);
  }
  return shown;
}

TEST(PairedSequence, AWrongClaimIsSeldomShown) {
  for (const double margin : {0.02, 0.05, 0.2}) {
    for (const double down : {0.0, 0.1, 0.3})
      EXPECT_LE(probability_of_showing(not_worse_by(margin), down + margin, down), kRisk) << margin << " " << down;
  }
  for (const double share : {0.02, 0.1, 0.4}) {
    EXPECT_LE(probability_of_showing(kWorse, share, share), kRisk) << share;
    EXPECT_LE(probability_of_showing(kImproved, share, share), kRisk) << share;
  }
}

TEST(PairedSequence, ARightClaimIsShown) {
  EXPECT_GT(probability_of_showing(not_worse_by(0.05), 0.0, 0.0), 0.999);
  EXPECT_GT(probability_of_showing(kWorse, 0.2, 0.0), 0.99);
  EXPECT_GT(probability_of_showing(kImproved, 0.02, 0.2), 0.99);
}

// The same numbers from the class, along one way through all worlds.
TEST(PairedSequence, FollowsItsDefinition) {
  const auto expect_same = [](PairedSequence sequence, const Claim& claim) {
    int up = 0, same = 0, down = 0;
    double most = 1.0;
    for (int i = 0; i < 200; ++i) {
      const int value = i % 17 == 3 ? 1 : i % 5 == 1 ? -1 : 0;
      ++(value > 0 ? up : value < 0 ? down : same);
      sequence.add({value, true});
      most = std::max(most, money(claim, up, same, down));
      EXPECT_TRUE(sequence.shows(1.0 / (most * 0.999))) << i;
      EXPECT_FALSE(sequence.shows(1.0 / (most * 1.001))) << i;
    }
  };
  expect_same(PairedSequence::not_worse_by(0.05), not_worse_by(0.05));
  expect_same(PairedSequence::worse(), kWorse);
  expect_same(PairedSequence::improved(), kImproved);
}

TEST(PairedSequence, AWorldThatWasThereBeforeCountsAgainstAClaimOnly) {
  auto not_worse = PairedSequence::not_worse_by(0.05), worse = PairedSequence::worse();
  for (int i = 0; i < 1000; ++i) {
    not_worse.add({0, false});
    worse.add({1, false});
  }
  EXPECT_FALSE(not_worse.shows(0.5));
  EXPECT_FALSE(worse.shows(0.5));
  auto spoiled = PairedSequence::not_worse_by(0.05);
  for (int i = 0; i < 20; ++i) spoiled.add({1, false});
  for (int i = 0; i < 100; ++i) spoiled.add({0, true});
  EXPECT_FALSE(spoiled.shows(0.05)) << "they had counted against it";
}

TEST(PairedSequence, TheBoundIsTheSmallestMarginThatIsShown) {
  std::vector<WorldDifference> worlds(200);
  for (std::size_t i = 0; i < worlds.size(); i += 40) worlds[i].value = 1;
  const double bound = difference_upper(worlds, 0.05);
  EXPECT_GT(bound, 5.0 / 200.0);
  EXPECT_LT(bound, 0.15);
  auto at = PairedSequence::not_worse_by(bound), below = PairedSequence::not_worse_by(bound - 1.0 / 2048);
  for (const WorldDifference& world : worlds) at.add(world), below.add(world);
  EXPECT_TRUE(at.shows(0.05));
  EXPECT_FALSE(below.shows(0.05));
  EXPECT_EQ(difference_upper({}, 0.05), 1.0);
}

}  // namespace
}  // namespace fleetproof::paired_sequence_test
