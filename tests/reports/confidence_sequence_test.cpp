#include "reports/evidence/confidence_sequence.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <cstdlib>

#include "tests/support/reference_table.hpp"

namespace fleetproof::confidence_sequence_test {
namespace {

using test::expect_close;
using test::reference_rows;

const bool kSeeded = setenv("RC_PARAMS", "seed=20261 max_success=400", 0) == 0;

bool holds(const char* name, void (*property)()) { return rc::check(name, property); }

TEST(BetaBinomialSequence, meets_the_reference_values) {
  for (const auto& row : reference_rows("cs_beta_binomial")) {
    const BetaPrior prior{row["prior_a"], row["prior_b"]};
    const auto k = row.count("k"), n = row.count("n");
    const auto interval = any_time_interval(k, n, Confidence::with_risk(row["alpha"]), prior);
    expect_close(interval.lower, row, "lower");
    expect_close(interval.upper, row, "upper");
    expect_close(log_mixture(k, n, 0.01, prior), row, "ln_M_at_p_0.01");
  }
}

// From the unit test of the implementation that Howard and others published.
TEST(BetaBinomialSequence, meets_a_published_value) {
  EXPECT_NEAR(log_mixture(135, 625, 0.2, {15.5507, 62.2028}), -0.6941012, 2e-7);
}

TEST(BetaBinomialSequence, units_needed_meet_the_reference_values) {
  for (const auto& row : reference_rows("gate_runs_needed")) {
    const auto needed = [&](const BetaPrior& prior) {
      return any_time_units_needed(row.count("failures_seen"), row["p_limit"], Confidence::with_risk(row["alpha"]),
                                   prior);
    };
    EXPECT_EQ(needed({0.05, 1.0}), row.count("anytime_cs_beta_0.05_1")) << row.line();
    EXPECT_EQ(needed({0.5, 0.5}), row.count("anytime_cs_beta_0.5_0.5")) << row.line();
  }
}

struct Sample {
  std::uint64_t k = 0, n = 1;
  Confidence confidence = 0.95;
  BetaPrior prior;
};

Sample any_sample() {
  const auto digits = *rc::gen::inRange(0, 10);
  Sample sample;
  sample.n =
      static_cast<std::uint64_t>(*rc::gen::inRange(1, 1000)) * static_cast<std::uint64_t>(std::pow(10.0, digits));
  sample.k = *rc::gen::inRange<std::uint64_t>(0, std::min<std::uint64_t>(sample.n, 100) + 1);
  if (*rc::gen::arbitrary<bool>()) sample.k = sample.n - sample.k;
  sample.confidence = Confidence::with_risk(std::pow(10.0, -*rc::gen::inRange(1, 8)));
  sample.prior = {*rc::gen::element(0.05, 0.5, 1.0, 20.0), *rc::gen::element(0.5, 1.0, 30.0)};
  return sample;
}

TEST(BetaBinomialSequence, contains_the_rate_and_ends_where_the_mixture_meets_the_risk) {
  EXPECT_TRUE(holds("edges of the sequence", [] {
    const Sample s = any_sample();
    const auto interval = any_time_interval(s.k, s.n, s.confidence, s.prior);
    const double rate = static_cast<double>(s.k) / static_cast<double>(s.n);
    RC_ASSERT(interval.lower <= rate);
    RC_ASSERT(rate <= interval.upper);
    const double goal = -std::log(s.confidence.risk());
    const auto log_m = [&](double p) { return log_mixture(s.k, s.n, p, s.prior); };
    // As near as the last bits of p allow.
    const auto meets_goal = [&](double p) {
      if (p <= 0.0 || p >= 1.0) return true;  // closer to 0 or 1 than doubles can tell
      const double of_last_bit = std::abs(log_m(p) - log_m(std::nextafter(p, rate)));
      return std::abs(log_m(p) - goal) < 1e-9 * goal + 4.0 * of_last_bit;
    };
    if (s.k > 0) RC_ASSERT(meets_goal(interval.lower));
    if (s.k < s.n) RC_ASSERT(meets_goal(interval.upper));
  }));
}

TEST(BetaBinomialSequence, is_monotone_in_failures_trials_and_risk) {
  EXPECT_TRUE(holds("monotone", [] {
    const Sample s = any_sample();
    RC_PRE(s.k < s.n);
    const auto interval = any_time_interval(s.k, s.n, s.confidence, s.prior);
    const auto one_more = any_time_interval(s.k + 1, s.n, s.confidence, s.prior);
    RC_ASSERT(one_more.lower >= interval.lower);
    RC_ASSERT(one_more.upper >= interval.upper * (1.0 - 1e-15));
    const auto surer = any_time_interval(s.k, s.n, s.confidence.shared(2.0), s.prior);
    RC_ASSERT(surer.lower <= interval.lower);
    RC_ASSERT(surer.upper >= interval.upper);
  }));
}

// How often a sequence of 200 trials ever leaves out the true probability, by the law of the failures, trial by trial.
double probability_of_a_miss(double p, Confidence confidence, const BetaPrior& prior) {
  constexpr std::uint64_t kTrials = 200;
  std::vector<double> law{1.0};  // of the failures, in campaigns that never missed
  double missed = 0.0;
  for (std::uint64_t n = 1; n <= kTrials; ++n) {
    std::vector<double> next(n + 1, 0.0);
    for (std::uint64_t k = 0; k < n; ++k) {
      next[k] += law[k] * (1.0 - p);
      next[k + 1] += law[k] * p;
    }
    for (std::uint64_t k = 0; k <= n; ++k) {
      const auto interval = any_time_interval(k, n, confidence, prior);
      if (interval.lower <= p && p <= interval.upper) continue;
      missed += next[k];
      next[k] = 0.0;
    }
    law = next;
  }
  return missed;
}

TEST(BetaBinomialSequence, misses_the_truth_at_no_time_more_often_than_the_risk) {
  EXPECT_LE(probability_of_a_miss(0.05, 0.8, {}), 0.2);
  EXPECT_LE(probability_of_a_miss(0.3, 0.8, {0.5, 0.5}), 0.2);
  EXPECT_GT(probability_of_a_miss(0.3, 0.8, {0.5, 0.5}), 0.02) << "it is not merely very wide";
}

TEST(BetaBinomialSequence, without_trials_nothing_is_known) {
  EXPECT_EQ(any_time_interval(0, 0, 0.95).lower, 0.0);
  EXPECT_EQ(any_time_interval(0, 0, 0.95).upper, 1.0);
  EXPECT_EQ(any_time_interval(5, 5, 0.95).upper, 1.0);
}

TEST(BetaBinomialSequence, units_needed_are_the_first_whose_interval_lies_below_the_limit) {
  EXPECT_TRUE(holds("first below", [] {
    const auto k = *rc::gen::inRange<std::uint64_t>(0, 30);
    const double limit = *rc::gen::element(0.9, 0.5, 0.1, 1e-3, 1e-6);
    const Confidence confidence = *rc::gen::element(0.5, 0.95, 0.99999);
    const auto n = any_time_units_needed(k, limit, confidence).value();
    RC_ASSERT(any_time_interval(k, n, confidence).upper <= limit * (1.0 + 1e-12));
    if (n > k + 1) RC_ASSERT(any_time_interval(k, n - 1, confidence).upper > limit * (1.0 - 1e-12));
  }));
  EXPECT_FALSE(any_time_units_needed(3, 1e-15, 0.95).has_value());
}

TEST(GammaPoissonSequence, meets_the_reference_values) {
  for (const auto& row : reference_rows("cs_gamma_poisson")) {
    const auto interval = any_time_rate(row.count("events"), row["exposure"], Confidence::with_risk(row["alpha"]),
                                        {row["prior_shape"], row["prior_rate"]});
    expect_close(interval.lower, row, "lower");
    expect_close(interval.upper, row, "upper");
  }
}

TEST(GammaPoissonSequence, contains_the_rate_and_follows_the_unit_of_time) {
  for (const std::uint64_t events : {0U, 1U, 50U, 1000000U}) {
    const double exposure = 2500.0;
    const auto in_hours = any_time_rate(events, exposure, 0.99),
               in_seconds =
                   any_time_rate(events, exposure * 3600.0, 0.99, {GammaPrior().shape, GammaPrior().rate * 3600.0});
    EXPECT_LE(in_hours.lower, static_cast<double>(events) / exposure);
    EXPECT_GE(in_hours.upper, static_cast<double>(events) / exposure);
    expect_close(in_seconds.lower * 3600.0, in_hours.lower, "lower");
    expect_close(in_seconds.upper * 3600.0, in_hours.upper, "upper");
  }
}

}  // namespace
}  // namespace fleetproof::confidence_sequence_test
