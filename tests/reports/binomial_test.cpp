#include "reports/evidence/binomial.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/error.hpp"
#include "reports/evidence/zero_failure.hpp"
#include "tests/support/reference_table.hpp"

namespace fleetproof::binomial_test {
namespace {

using test::expect_close;
using test::reference_rows;

TEST(ClopperPearson, meets_the_reference_values) {
  for (const auto& row : reference_rows("clopper_pearson")) {
    const auto k = row.count("k"), n = row.count("n");
    const auto interval = two_sided_interval(k, n, row["confidence"]);
    expect_close(interval.lower, row, "two_sided_lower");
    expect_close(interval.upper, row, "two_sided_upper");
    expect_close(lower_bound(k, n, row["confidence"]), row, "one_sided_lower");
    expect_close(upper_bound(k, n, row["confidence"]), row, "one_sided_upper");
  }
}

TEST(ClopperPearson, without_trials_nothing_is_known) {
  EXPECT_EQ(lower_bound(0, 0, 0.95), 0.0);
  EXPECT_EQ(upper_bound(0, 0, 0.95), 1.0);
  EXPECT_EQ(two_sided_interval(0, 0, 0.95).upper, 1.0);
}

TEST(ClopperPearson, is_monotone_and_covers_the_rate) {
  for (std::uint64_t n = 1; n <= 40; ++n) {
    for (std::uint64_t k = 0; k <= n; ++k) {
      const auto rate = static_cast<double>(k) / static_cast<double>(n);
      const auto interval = two_sided_interval(k, n, 0.95);
      ASSERT_LE(interval.lower, rate);
      ASSERT_GE(interval.upper, rate);
      ASSERT_LE(interval.lower, lower_bound(k, n, 0.95));
      ASSERT_GE(interval.upper, upper_bound(k, n, 0.95));
      ASSERT_LE(upper_bound(k, n + 1, 0.95), upper_bound(k, n, 0.95));
      if (k == n) continue;
      ASSERT_LE(upper_bound(k, n, 0.95), upper_bound(k + 1, n, 0.95));
    }
  }
}

// The probability of each number of failures, by the ratio of neighbours.
std::vector<long double> law_of_failures(std::uint64_t n, long double p) {
  std::vector<long double> law(n + 1);
  law[0] = std::pow(1.0L - p, static_cast<long double>(n));
  for (std::uint64_t k = 0; k < n; ++k)
    law[k + 1] = law[k] * static_cast<long double>(n - k) / static_cast<long double>(k + 1) * p / (1.0L - p);
  return law;
}

TEST(ClopperPearson, covers_every_rate_with_the_confidence) {
  constexpr double kConfidence = 0.9;
  for (const std::uint64_t n : {1U, 7U, 30U, 100U}) {
    for (int step = 1; step < 200; ++step) {
      const double p = step / 200.0;
      const auto law = law_of_failures(n, p);
      long double by_upper = 0.0, by_lower = 0.0, by_both = 0.0;
      for (std::uint64_t k = 0; k <= n; ++k) {
        const auto both = two_sided_interval(k, n, kConfidence);
        if (p <= upper_bound(k, n, kConfidence)) by_upper += law[k];
        if (p >= lower_bound(k, n, kConfidence)) by_lower += law[k];
        if (both.lower <= p && p <= both.upper) by_both += law[k];
      }
      EXPECT_GE(by_upper, kConfidence - 1e-12) << n << " " << p;
      EXPECT_GE(by_lower, kConfidence - 1e-12) << n << " " << p;
      EXPECT_GE(by_both, kConfidence - 1e-12) << n << " " << p;
    }
  }
}

TEST(ClopperPearson, at_a_bound_the_tail_has_the_risk) {
  for (const std::uint64_t n : {5U, 100U, 2000U}) {
    for (const std::uint64_t k : {std::uint64_t{1}, n / 10 + 1, n / 2}) {
      for (const double risk : {0.3, 0.05, 1e-6}) {
        const Confidence confidence = Confidence::with_risk(risk);
        long double at_most = 0.0, at_least = 0.0;
        const auto at_upper = law_of_failures(n, upper_bound(k, n, confidence)),
                   at_lower = law_of_failures(n, lower_bound(k, n, confidence));
        for (std::uint64_t i = 0; i <= k; ++i) at_most += at_upper[i];
        for (std::uint64_t i = k; i <= n; ++i) at_least += at_lower[i];
        expect_close(static_cast<double>(at_most), risk, "upper bound");
        expect_close(static_cast<double>(at_least), risk, "lower bound");
      }
    }
  }
}

// Values from tail sums with 45 digits, far from the usual sizes.
TEST(ClopperPearson, keeps_its_digits_at_extreme_sizes_and_risks) {
  const auto risk = [](double value) { return Confidence::with_risk(value); };
  expect_close(lower_bound(1, 1000000000, risk(0.05)), 5.129329438623503e-11, "1 of 1000000000", 1e-13);
  expect_close(upper_bound(1, 1000000000, risk(0.05)), 4.743864509510385e-9, "1 of 1000000000", 1e-13);
  expect_close(upper_bound(2, 1000000000, risk(0.25)), 3.920402056528186e-9, "2 of 1000000000", 1e-13);
  expect_close(lower_bound(40, 1000000000, risk(1e-6)), 1.675315042066047e-8, "40 of 1000000000", 1e-13);
  expect_close(upper_bound(40, 1000000000, risk(1e-6)), 7.891082737263288e-8, "40 of 1000000000", 1e-13);
  expect_close(lower_bound(1000, 1000000000, risk(0.05)), 9.485598733064084e-7, "1000 of 1000000000", 1e-13);
  expect_close(upper_bound(1000, 1000000000, risk(0.05)), 1.053603093895086e-6, "1000 of 1000000000", 1e-13);
  expect_close(lower_bound(999997, 1000000, risk(1e-6)), 0.999978649738931, "999997 of 1000000", 1e-13);
  expect_close(upper_bound(999997, 1000000, risk(1e-6)), 0.9999999817456989, "999997 of 1000000", 1e-13);
  expect_close(lower_bound(500000, 1000000, risk(1e-12)), 0.4964823024946119, "500000 of 1000000", 1e-13);
  expect_close(upper_bound(500000, 1000000, risk(1e-12)), 0.5035176975053881, "500000 of 1000000", 1e-13);
  expect_close(lower_bound(7, 1000000000000, risk(0.05)), 3.285315691899131e-12, "7 of 1000000000000", 1e-13);
  expect_close(upper_bound(7, 1000000000000, risk(0.05)), 1.31481138023917e-11, "7 of 1000000000000", 1e-13);
}

TEST(ClopperPearson, a_risk_keeps_the_digits_that_a_confidence_has) {
  EXPECT_EQ(Confidence(0.95).risk(), 0.05);
  EXPECT_EQ(Confidence(0.999999).risk(), 1e-6);
  EXPECT_EQ(Confidence(0.999999999999999).risk(), 1e-15);
  EXPECT_EQ(Confidence(0.123).risk(), 0.877);
  EXPECT_EQ(lower_bound(1, 10, 0.999999), lower_bound(1, 10, Confidence::with_risk(1e-6)));
}

TEST(ClopperPearson, refuses_what_makes_no_sense) {
  EXPECT_THROW(upper_bound(3, 2, 0.95), InvariantViolation);
  EXPECT_THROW(lower_bound(1, 2, 1.0), InvariantViolation);
  EXPECT_THROW(two_sided_interval(1, 2, 0.0), InvariantViolation);
}

TEST(ZeroFailures, bound_meets_the_reference_values) {
  for (const auto& row : reference_rows("zero_failure_bound")) {
    expect_close(zero_failure_bound(row.count("n"), row["confidence"]), row, "upper_exact");
    expect_close(zero_failure_poisson_bound(row.count("n"), row["confidence"]), row, "upper_poisson_approx");
    EXPECT_EQ(upper_bound(0, row.count("n"), row["confidence"]), zero_failure_bound(row.count("n"), row["confidence"]));
  }
}

TEST(ZeroFailures, plan_meets_the_reference_values) {
  for (const auto& row : reference_rows("zero_failure_plan")) {
    const auto units = zero_failure_units(row["p_limit"], row["confidence"]);
    ASSERT_EQ(units, row.count("n_min")) << row.line();
    EXPECT_EQ(units_needed(0, row["p_limit"], row["confidence"]), units);
    expect_close(zero_failure_probability(*units, row["p_limit"] / 10), row, "pass_prob_if_true_p_is_limit_over_10");
    expect_close(zero_failure_probability(*units, row["p_limit"] / 100), row, "pass_prob_if_true_p_is_limit_over_100");
  }
}

TEST(ZeroFailures, a_plan_that_meets_the_risk_exactly_is_enough) {
  EXPECT_EQ(zero_failure_units(0.1, Confidence::with_risk(0.81)), 2U);
  EXPECT_EQ(zero_failure_units(0.1, Confidence::with_risk(0.729)), 3U);
  EXPECT_EQ(zero_failure_units(0.5, Confidence::with_risk(0.0625)), 4U);
  EXPECT_EQ(zero_failure_units(0.5, Confidence::with_risk(0.0624)), 5U);
}

TEST(UnitsNeeded, meets_the_reference_values) {
  for (const auto& row : reference_rows("acceptance_plan")) {
    const auto failing = row.count("accept_if_failures_at_most");
    const double limit = row["p_limit"];
    const auto units = units_needed(failing, limit, row["confidence"]);
    ASSERT_EQ(units, row.count("n_min")) << row.line();
    expect_close(probability_of_at_most(failing, *units, limit), row, "pass_prob_at_limit");
    expect_close(probability_of_at_most(failing, *units, limit / 2), row, "pass_prob_at_limit_over_2");
    expect_close(probability_of_at_most(failing, *units, limit / 10), row, "pass_prob_at_limit_over_10");
  }
}

TEST(UnitsNeeded, is_the_least_number_whose_bound_meets_the_limit) {
  for (const std::uint64_t k : {0U, 1U, 7U}) {
    for (const double limit : {0.3, 0.05, 1e-3}) {
      const auto n = units_needed(k, limit, 0.95).value();
      EXPECT_LE(upper_bound(k, n, 0.95), limit);
      EXPECT_GT(upper_bound(k, n - 1, 0.95), limit);
    }
  }
}

TEST(UnitsNeeded, no_number_meets_a_limit_of_zero) {
  EXPECT_FALSE(units_needed(0, 0.0, 0.95).has_value());
  EXPECT_FALSE(units_needed(0, -1.0, 0.95).has_value());
  EXPECT_FALSE(units_needed(0, 1e-18, 0.95).has_value());
  EXPECT_FALSE(units_needed(3, 1e-18, 0.95).has_value());
}

TEST(ProbabilityOfAtMost, is_exact_at_the_ends) {
  EXPECT_EQ(probability_of_at_most(0, 0, 0.5), 1.0);
  EXPECT_EQ(probability_of_at_most(3, 10, 0.0), 1.0);
  EXPECT_EQ(probability_of_at_most(3, 10, 1.0), 0.0);
  EXPECT_EQ(probability_of_at_most(10, 10, 1.0), 1.0);
  EXPECT_DOUBLE_EQ(probability_of_at_most(1, 2, 0.5), 0.75);
}

}  // namespace
}  // namespace fleetproof::binomial_test
