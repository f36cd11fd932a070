// Strata of a profile, cells of loss x delay, and clusters of runs.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <cstdlib>

#include "core/base/error.hpp"
#include "reports/evidence/binomial.hpp"
#include "reports/evidence/clusters.hpp"
#include "reports/evidence/envelope.hpp"
#include "reports/evidence/strata.hpp"
#include "tests/support/reference_table.hpp"

namespace fleetproof::grouped_evidence_test {
namespace {

using test::expect_close;
using test::reference_rows;

const bool kSeeded = setenv("RC_PARAMS", "seed=20261 max_success=400", 0) == 0;

bool holds(const char* name, void (*property)()) { return rc::check(name, property); }

TEST(Strata, meet_the_reference_values) {
  for (const auto& row : reference_rows("stratified_zero_failure")) {
    const auto weights = row.list("weights"), units = row.list("runs_per_stratum");
    std::vector<Stratum> strata;
    for (std::size_t i = 0; i < weights.size(); ++i)
      strata.push_back({weights[i], static_cast<std::uint64_t>(units[i]), 0});
    const Confidence confidence = Confidence::with_risk(row["alpha"]);
    expect_close(stratified_zero_failure_bound(strata, confidence), row, "buehler_upper");
    expect_close(stratified_bound(strata, confidence), row, "bonferroni_sum_upper");
    expect_close(pooled_bound(strata, confidence), row, "naive_pooled_upper_WRONG_unless_proportional");
  }
}

std::vector<Stratum> any_strata() {
  std::vector<Stratum> strata(*rc::gen::inRange<std::size_t>(1, 6));
  double sum = 0.0;
  for (Stratum& stratum : strata) {
    stratum.weight = *rc::gen::inRange(1, 1000);
    stratum.units = *rc::gen::inRange<std::uint64_t>(1, *rc::gen::element<std::uint64_t>(20, 5000));
    sum += stratum.weight;
  }
  for (Stratum& stratum : strata) stratum.weight /= sum;
  return strata;
}

// No failure anywhere, in strata with these probabilities of failure.
double log_probability_of_no_failure(const std::vector<Stratum>& strata, const std::vector<double>& p) {
  double log_probability = 0.0;
  for (std::size_t i = 0; i < strata.size(); ++i)
    log_probability += static_cast<double>(strata[i].units) * std::log1p(-p[i]);
  return log_probability;
}

TEST(Strata, whatever_lies_above_the_exact_bound_fails_often_enough) {
  EXPECT_TRUE(holds("coverage", [] {
    const auto strata = any_strata();
    const Confidence confidence = 0.95;
    const double bound = stratified_zero_failure_bound(strata, confidence);
    // Any direction, as far as the bound.
    std::vector<double> p;
    double sum = 0.0;
    for (const Stratum& stratum : strata) {
      p.push_back(*rc::gen::inRange(0, 1000));
      sum += stratum.weight * p.back();
    }
    RC_PRE(sum > 0.0);
    for (double& one : p) one = std::min(0.999999, one * bound / sum * (1.0 + 1e-9));
    double reached = 0.0;
    for (std::size_t i = 0; i < p.size(); ++i) reached += strata[i].weight * p[i];
    RC_PRE(reached >= bound);
    RC_ASSERT(log_probability_of_no_failure(strata, p) <= std::log(confidence.risk()) + 1e-9);
  }));
}

// The solution by its definition: 1 - p = min(1, mu units / weight), with mu so that no failure has the risk.
double bound_by_search(const std::vector<Stratum>& strata, double risk) {
  const auto passing = [](const Stratum& stratum, double log_mu) {
    return std::min(1.0, std::exp(log_mu) * static_cast<double>(stratum.units) / stratum.weight);
  };
  double low = -100.0, high = 100.0;
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2.0;
    double log_probability = 0.0;
    for (const Stratum& stratum : strata)
      log_probability += static_cast<double>(stratum.units) * std::log(passing(stratum, middle));
    (log_probability < std::log(risk) ? low : high) = middle;
  }
  double sum = 0.0;
  for (const Stratum& stratum : strata) sum += stratum.weight * (1.0 - passing(stratum, low));
  return sum;
}

TEST(Strata, the_exact_bound_is_the_solution_of_its_definition) {
  EXPECT_TRUE(holds("definition", [] {
    const auto strata = any_strata();
    const double searched = bound_by_search(strata, 0.05);
    RC_ASSERT(std::abs(stratified_zero_failure_bound(strata, 0.95) - searched) < 1e-9 * searched + 1e-13);
  }));
}

TEST(Strata, the_exact_bound_lies_between_the_pooled_and_the_bonferroni_bound) {
  EXPECT_TRUE(holds("order", [] {
    const auto strata = any_strata();
    const double exact = stratified_zero_failure_bound(strata, 0.95);
    RC_ASSERT(exact >= pooled_bound(strata, 0.95) * (1.0 - 1e-12));
    RC_ASSERT(exact <= stratified_bound(strata, 0.95) * (1.0 + 1e-12));
  }));
}

TEST(Strata, without_units_a_stratum_counts_in_full) {
  expect_close(stratified_zero_failure_bound({{0.3, 0}, {0.7, 100}}, 0.95), 0.3 + 0.7 * pooled_bound({{1, 100}}, 0.95),
               "one empty stratum");
  EXPECT_EQ(stratified_zero_failure_bound({{0.3, 0}, {0.7, 0}}, 0.95), 1.0);
  EXPECT_THROW(stratified_zero_failure_bound({{1.0, 10, 1}}, 0.95), InvariantViolation);
}

TEST(Envelope, meets_the_reference_values) {
  const auto rows = reference_rows("envelope_example");
  EnvelopeGrid grid(3, std::vector<EnvelopeCell>(3));
  for (const auto& row : rows)
    grid[row.count("loss_index")][row.count("delay_index")] = {row.count("k"), row.count("n")};
  const std::vector<EnvelopePlace> path = {{0, 0}, {0, 1}, {1, 1}, {1, 2}, {2, 2}};
  const auto p_values = envelope_p_values(grid, 0.001);
  const auto claimed = safe_envelope(grid, 0.001, 0.95);
  const auto by_bonferroni = bonferroni_envelope(grid, 0.001, 0.95);
  const auto on_path = claimed_on_path(grid, path, 0.001, 0.95);
  for (const auto& row : rows) {
    const auto loss = row.count("loss_index"), delay = row.count("delay_index");
    expect_close(p_values[loss][delay], row, "p_value_H0_p_ge_limit");
    EXPECT_EQ(claimed[loss][delay], row.count("claim_antichain_3") == 1) << row.line();
    EXPECT_EQ(by_bonferroni[loss][delay], row.count("claim_bonferroni_9") == 1) << row.line();
    const EnvelopeCell own = grid[loss][delay], pool = monotone_pool(grid, {loss, delay});
    expect_close(upper_bound(own.failing, own.units, 0.95), row, "cp_upper_own");
    expect_close(upper_bound(pool.failing, pool.units, 0.95), row, "cp_upper_monotone_pooled");
    if (!row.has("claim_fixed_sequence_staircase")) continue;
    const auto place = std::ranges::find_if(
        path, [&](const EnvelopePlace& there) { return there.loss == loss && there.delay == delay; });
    ASSERT_NE(place, path.end());
    EXPECT_EQ(static_cast<std::size_t>(place - path.begin()) < on_path,
              row.count("claim_fixed_sequence_staircase") == 1);
  }
}

// Every choice of unsafe cells in a small grid, each exactly at the limit, all others perfect: the probability of any
// false claim, summed over all outcomes of the unsafe cells.
double probability_of_a_false_claim(unsigned unsafe, std::size_t rows, std::size_t columns) {
  constexpr std::uint64_t kUnits = 50, kOutcomes = 4;  // 0, 1, 2, and 3 or more failures
  constexpr double kLimit = 0.1;
  double law[kOutcomes] = {std::pow(0.9, 50), 50 * 0.1 * std::pow(0.9, 49), 1225 * 0.01 * std::pow(0.9, 48), 0.0};
  law[3] = 1.0 - law[0] - law[1] - law[2];
  const std::size_t cells = rows * columns;
  std::uint64_t outcomes = 1;
  for (std::size_t i = 0; i < cells; ++i) outcomes *= kOutcomes;
  double sum = 0.0;
  for (std::uint64_t outcome = 0; outcome < outcomes; ++outcome) {
    EnvelopeGrid grid(rows, std::vector<EnvelopeCell>(columns, {0, kUnits}));
    double probability = 1.0;
    std::uint64_t rest = outcome;
    for (std::size_t i = 0; i < cells; ++i, rest /= kOutcomes) {
      const bool is_unsafe = (unsafe >> i & 1U) != 0;
      if (is_unsafe) grid[i / columns][i % columns].failing = rest % kOutcomes;
      probability *= is_unsafe ? law[rest % kOutcomes] : (rest % kOutcomes == 0 ? 1.0 : 0.0);
    }
    if (probability == 0.0) continue;
    const auto claimed = safe_envelope(grid, kLimit, 0.8);
    bool any_false = false;
    for (std::size_t i = 0; i < cells; ++i)
      any_false = any_false || ((unsafe >> i & 1U) != 0 && claimed[i / columns][i % columns]);
    if (any_false) sum += probability;
  }
  return sum;
}

TEST(Envelope, claims_nothing_false_with_more_than_the_risk) {
  double largest = 0.0;
  for (unsigned unsafe = 0; unsafe < 16; ++unsafe)
    largest = std::max(largest, probability_of_a_false_claim(unsafe, 2, 2));
  for (unsigned unsafe = 0; unsafe < 16; ++unsafe)
    largest = std::max(largest, probability_of_a_false_claim(unsafe, 1, 4));
  EXPECT_LE(largest, 0.2);
  EXPECT_GT(largest, 0.05);
}

TEST(Envelope, a_cell_is_claimed_with_all_its_predecessors) {
  EXPECT_TRUE(holds("closed", [] {
    EnvelopeGrid grid(*rc::gen::inRange<std::size_t>(1, 5));
    const auto columns = *rc::gen::inRange<std::size_t>(1, 5);
    for (auto& row : grid) {
      for (std::size_t i = 0; i < columns; ++i) row.push_back({*rc::gen::inRange<std::uint64_t>(0, 4), 6000});
    }
    const auto claimed = safe_envelope(grid, 1e-3, 0.95);
    const auto p_values = envelope_p_values(grid, 1e-3);
    const double risk = 0.05 / static_cast<double>(std::min(grid.size(), columns));
    for (std::size_t loss = 0; loss < grid.size(); ++loss) {
      for (std::size_t delay = 0; delay < columns; ++delay) {
        bool all = true;
        for (std::size_t i = 0; i <= loss; ++i)
          for (std::size_t j = 0; j <= delay; ++j) all = all && p_values[i][j] <= risk;
        RC_ASSERT(claimed[loss][delay] == all);
      }
    }
  }));
}

TEST(Clusters, are_the_units_of_a_claim_about_clusters) {
  const auto units = cluster_units({{0, 100}, {7, 100}, {1, 3}, {0, 0}});
  EXPECT_EQ(units.units, 3U) << "a cluster without runs says nothing";
  EXPECT_EQ(units.failing, 2U);
}

TEST(DesignEffect, of_equal_runs_is_the_size_of_the_clusters) {
  // All runs of a layout end alike: 4 layouts tell as much as 3 or 4 runs.
  const auto effect = design_effect({{5, 5}, {0, 5}, {5, 5}, {0, 5}});
  EXPECT_DOUBLE_EQ(effect.rate, 0.5);
  EXPECT_DOUBLE_EQ(effect.cluster_variance, 4.0 / 3.0 * 25.0 / 400.0);
  EXPECT_DOUBLE_EQ(effect.binomial_variance, 0.25 / 20.0);
  EXPECT_DOUBLE_EQ(effect.ratio.value(), 20.0 / 3.0);
  EXPECT_DOUBLE_EQ(effect.effective_units.value(), 3.0);
}

TEST(DesignEffect, of_clusters_of_one_run_is_about_one) {
  std::vector<Cluster> clusters(1000, {0, 1});
  for (std::size_t i = 0; i < 100; ++i) clusters[i].failing = 1;
  EXPECT_NEAR(design_effect(clusters).ratio.value(), 1000.0 / 999.0, 1e-12);
}

TEST(DesignEffect, is_unknown_without_failures_or_with_one_cluster) {
  EXPECT_FALSE(design_effect({{0, 10}, {0, 20}}).ratio.has_value());
  EXPECT_FALSE(design_effect({{10, 10}, {20, 20}}).ratio.has_value());
  EXPECT_FALSE(design_effect({{3, 10}}).ratio.has_value());
  EXPECT_FALSE(design_effect({{1, 10}, {1, 10}}).effective_units.has_value()) << "no variance: more than any number";
  EXPECT_THROW(design_effect({{0, 0}}), InvariantViolation);
}

TEST(Dispersion, compares_runs_with_a_poisson_count) {
  // One jam of 12 incidents in four runs of 2 h: rate 1.5/h.
  const auto result = dispersion({{12, 2.0}, {0, 2.0}, {0, 2.0}, {0, 2.0}});
  EXPECT_DOUBLE_EQ(result.rate, 1.5);
  EXPECT_DOUBLE_EQ(result.run_variance, 4.0 / 3.0 * (81.0 + 27.0) / 64.0);
  EXPECT_DOUBLE_EQ(result.poisson_variance, 1.5 / 8.0);
  EXPECT_DOUBLE_EQ(result.ratio.value(), 12.0);
  EXPECT_FALSE(dispersion({{0, 1.0}, {0, 1.0}}).ratio.has_value());
}

}  // namespace
}  // namespace fleetproof::grouped_evidence_test
