// Ten thousand campaigns on software that is exactly at the limit, where how often a world fails depends on its layout
// and the claim is about layouts drawn from the family. What the pooled worlds of few fixed layouts show is about
// these layouts. Every share of the table is computed here from the binomial distribution as well.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "reports/evidence/clusters.hpp"
#include "tests/reports/synthetic_campaigns.hpp"

namespace fleetproof::few_layouts_test {
namespace {

using namespace synthetic;

struct Kind {
  double share, rate;  // of the layouts of the family; of the worlds on such a layout that fail
};
using Family = std::vector<Kind>;

// In both, a world on a layout that is drawn for it fails with probability 0.1, the limit.
const Family kUneven = {{0.7, 0.01}, {0.2, 0.165}, {0.1, 0.6}};
const Family kAllOrNothing = {{0.9, 0.0}, {0.1, 1.0}};

using Chances = std::vector<double>;  // of 0, 1, 2, ... failures

Chances binomial(std::uint64_t units, double rate) {
  Chances chances{1.0};
  for (std::uint64_t i = 0; i < units; ++i) {
    chances.push_back(0.0);
    for (std::size_t k = chances.size(); k-- > 0;)
      chances[k] = chances[k] * (1.0 - rate) + (k > 0 ? chances[k - 1] * rate : 0.0);
  }
  return chances;
}

Chances sum_of(const Chances& a, const Chances& b) {
  Chances sum(a.size() + b.size() - 1);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) sum[i + j] += a[i] * b[j];
  }
  return sum;
}

// Of the failures that have a chance of 5 % or less together if a unit at the limit fails: what they pass with here.
double passing(const Chances& truth, const Chances& at_limit) {
  double risk = 0.0, passed = 0.0;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    risk += at_limit[k];
    if (risk > 1.0 - kConfidence) break;
    passed += truth[k];
  }
  return passed;
}

bool shown(std::uint64_t failing, std::uint64_t units) {
  static const std::vector<std::uint64_t> needed = [] {
    std::vector<std::uint64_t> list;
    for (std::uint64_t k = 0; k <= 600; ++k) list.push_back(*units_needed(k, kLimit, kConfidence));
    return list;
  }();
  return units >= needed.at(failing);
}

// The product passes a claim with exactly the numbers of failures that `passing` counts.
void expect_passed_by_the_product(const Chances& at_limit) {
  double risk = 0.0;
  for (std::size_t k = 0; k < at_limit.size(); ++k) {
    risk += at_limit[k];
    EXPECT_EQ(shown(k, at_limit.size() - 1), risk <= 1.0 - kConfidence) << k << " of " << at_limit.size() - 1;
  }
}

struct Campaign {
  const Family& family;
  std::uint64_t layouts, worlds_each;

  std::uint64_t worlds() const { return layouts * worlds_each; }
  double mean(const std::function<double(double rate)>& of) const {
    return std::accumulate(family.begin(), family.end(), 0.0,
                           [&](double sum, const Kind& kind) { return sum + kind.share * of(kind.rate); });
  }
  double rate() const {
    return mean([](double rate) { return rate; });
  }
  double between_layouts() const {  // variance
    return mean([this](double each) { return (each - rate()) * (each - rate()); });
  }
  Chances of_pooled_worlds() const {
    Chances of_layout(worlds_each + 1), all{1.0};
    for (const Kind& kind : family) {
      const Chances chances = binomial(worlds_each, kind.rate);
      for (std::size_t k = 0; k < chances.size(); ++k) of_layout[k] += kind.share * chances[k];
    }
    for (std::uint64_t i = 0; i < layouts; ++i) all = sum_of(all, of_layout);
    return all;
  }
  double failing_layout() const {
    return mean([this](double each) { return 1.0 - std::pow(1.0 - each, static_cast<double>(worlds_each)); });
  }
};

double drawn_rate(Draws& draws, const Family& family) {
  double left = uniform(draws);
  for (const Kind& kind : family) {
    if (left < kind.share) return kind.rate;
    left -= kind.share;
  }
  return family.back().rate;
}

std::vector<Cluster> fixed_layouts(const Campaign& campaign, std::uint64_t seed) {
  Draws draws(seed, 2);
  std::vector<Cluster> clusters;
  for (std::uint64_t i = 0; i < campaign.layouts; ++i) {
    const double rate = drawn_rate(draws, campaign.family);
    Cluster& cluster = clusters.emplace_back(Cluster{0, campaign.worlds_each});
    for (std::uint64_t world = 0; world < campaign.worlds_each; ++world) cluster.failing += uniform(draws) < rate;
  }
  return clusters;
}

bool a_layout_for_each_world(const Campaign& campaign, std::uint64_t seed) {
  Draws draws(seed, 3);
  std::uint64_t failing = 0;
  for (std::uint64_t world = 0; world < campaign.worlds(); ++world) {
    const double rate = drawn_rate(draws, campaign.family);
    failing += uniform(draws) < rate;
  }
  return shown(failing, campaign.worlds());
}
bool worlds_of_fixed_layouts(const Campaign& campaign, std::uint64_t seed) {
  std::uint64_t failing = 0;
  for (const Cluster& cluster : fixed_layouts(campaign, seed)) failing += cluster.failing;
  return shown(failing, campaign.worlds());
}
bool layouts_as_units(const Campaign& campaign, std::uint64_t seed) {
  const ClusterUnits units = cluster_units(fixed_layouts(campaign, seed));
  return shown(units.failing, units.units);
}
// As many worlds as the design effect leaves, rounded down. Without a failing world there is no design effect.
bool worlds_by_design_effect(const Campaign& campaign, std::uint64_t seed) {
  const DesignEffect effect = design_effect(fixed_layouts(campaign, seed));
  const double units =
      std::min(effect.effective_units.value_or(static_cast<double>(effect.units)), static_cast<double>(effect.units));
  return shown(static_cast<std::uint64_t>(std::ceil(effect.rate * units)), static_cast<std::uint64_t>(units));
}

struct Row {
  Campaign campaign;
  // Shares of campaigns that pass, all of them falsely: a layout drawn for each world, pooled worlds of fixed layouts,
  // layouts as units; and the design effect of the fixed layouts.
  double fresh, pooled, layouts, effect;
};
const std::vector<Row> kTable = {
    {{kUneven, 3, 100}, 0.0458, 0.5726, 0.0, 35.67},
    {{kUneven, 4, 100}, 0.0357, 0.5300, 0.0, 35.67},
    {{kUneven, 5, 100}, 0.0393, 0.5024, 0.0, 35.67},
    {{kAllOrNothing, 60, 10}, 0.0409, 0.2710, 0.0138, 10.0},
};

void expect_share(const std::function<bool(const Campaign&, std::uint64_t)>& method, const Campaign& campaign,
                  double exact) {
  const double share = share_of([&](std::uint64_t seed) { return method(campaign, seed); });
  EXPECT_LE(share, most_by_chance(exact)) << campaign.layouts << " layouts";
  EXPECT_GE(share, least_by_chance(exact)) << campaign.layouts << " layouts";
}

TEST(FewLayouts, TheTableAndTheProductFollowTheBinomialDistribution) {
  for (const auto& [campaign, fresh, pooled, layouts, effect] : kTable) {
    ASSERT_NEAR(campaign.rate(), kLimit, 1e-12);
    const Chances worlds_at_limit = binomial(campaign.worlds(), kLimit);
    expect_passed_by_the_product(worlds_at_limit);
    expect_passed_by_the_product(binomial(campaign.layouts, kLimit));
    EXPECT_NEAR(passing(worlds_at_limit, worlds_at_limit), fresh, 5e-5);
    EXPECT_NEAR(passing(campaign.of_pooled_worlds(), worlds_at_limit), pooled, 5e-5);
    EXPECT_NEAR(passing(binomial(campaign.layouts, campaign.failing_layout()), binomial(campaign.layouts, kLimit)),
                layouts, 5e-5);
    const double alike = campaign.between_layouts() / (kLimit * (1.0 - kLimit));  // correlation within a layout
    EXPECT_NEAR(1.0 + static_cast<double>(campaign.worlds_each - 1) * alike, effect, 5e-3);
    EXPECT_LE(std::max(fresh, layouts), 1.0 - kConfidence) << "these keep their risk";
  }
}

TEST(FewLayouts, ALayoutDrawnForEachWorldKeepsTheRisk) {
  for (const Row& row : kTable) expect_share(a_layout_for_each_world, row.campaign, row.fresh);
}

TEST(FewLayouts, PooledWorldsOfFixedLayoutsAreNoUnits) {
  for (const Row& row : kTable) {
    expect_share(worlds_of_fixed_layouts, row.campaign, row.pooled);
    EXPECT_GT(least_by_chance(row.pooled), most_by_chance()) << "far above the risk of 5 %";
  }
}

TEST(FewLayouts, LayoutsAsUnitsKeepTheRisk) {
  for (const Row& row : kTable) expect_share(layouts_as_units, row.campaign, row.layouts);
  // One failing world in ten fails its layout: here a layout fails with probability 0.1, its worlds with 0.01.
  const Family seldom = {{1.0, 1.0 - std::pow(0.9, 0.1)}};
  const Campaign campaign{seldom, 60, 10};
  expect_share(layouts_as_units, campaign, passing(binomial(60, campaign.failing_layout()), binomial(60, kLimit)));
  // Without a failure, 28 layouts are too few and 29 are enough: a claim has no more units than that.
  EXPECT_FALSE(shown(0, 28));
  EXPECT_TRUE(shown(0, 29));
}

// It is itself an estimate from few layouts: if the bad ones are not among them, they seem to be alike.
TEST(FewLayouts, ADesignEffectOfFewLayoutsIsNoRemedy) {
  for (std::size_t row = 0; row < 3; ++row) {
    const Campaign& campaign = kTable[row].campaign;
    EXPECT_GT(share_of([&](std::uint64_t seed) { return worlds_by_design_effect(campaign, seed); }), most_by_chance());
  }
}

// On average it is right: the variance between layouts that it takes has no bias.
TEST(FewLayouts, TheVarianceBehindTheDesignEffectHasNoBias) {
  for (const Row& row : kTable) {
    double sum = 0.0, squares = 0.0;
    for (std::uint64_t seed = 0; seed < kCampaigns; ++seed) {
      const double variance = design_effect(fixed_layouts(row.campaign, seed)).cluster_variance;
      sum += variance;
      squares += variance * variance;
    }
    const auto n = static_cast<double>(kCampaigns);
    const double spread = std::sqrt((squares / n - sum * sum / (n * n)) / n);
    const double independent = kLimit * (1.0 - kLimit) / static_cast<double>(row.campaign.worlds());
    EXPECT_NEAR(sum / n, row.effect * independent, 5.0 * spread + 0.005 * independent);
  }
}

}  // namespace
}  // namespace fleetproof::few_layouts_test
