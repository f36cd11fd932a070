#include "reports/evidence/binomial.hpp"

#include <gtest/gtest.h>

#include "core/base/error.hpp"

namespace fleetproof {
namespace {

void expect_close(double actual, double expected) { EXPECT_NEAR(actual, expected, 1e-10 * expected) << expected; }

// Reference values from tail sums with 60 digits, found without inverse special functions.
struct ClopperPearson {
  std::uint64_t k, n;
  double confidence, two_sided_lower, two_sided_upper, one_sided_lower, one_sided_upper;
};
constexpr ClopperPearson kClopperPearson[] = {
    {0, 10, 0.9, 0, 0.258865550893052, 0, 0.205671765275718},
    {1, 10, 0.99, 0.000501128575464634, 0.544287056899687, 0.00100452870824995, 0.504352662930801},
    {5, 10, 0.95, 0.187086028447399, 0.812913971552601, 0.222441101008129, 0.777558898991871},
    {10, 10, 0.95, 0.691502892181239, 1.0, 0.741134449106948, 1.0},
    {0, 59, 0.95, 0, 0.0606089009503398, 0, 0.0495076098882269},
    {2, 100, 0.95, 0.00243133682394254, 0.0703839324710701, 0.00356515260325675, 0.0616192003960407},
    {3, 1000, 0.95, 0.000619099931649571, 0.0087420232384783, 0.0008181753982218, 0.00773524471847946},
    {500, 1000, 0.95, 0.468549172971792, 0.531450827028208, 0.473517731235691, 0.526482268764309},
    {5, 100000, 0.99, 1.0779439899175e-5, 0.000141491120887922, 1.27912348202787e-5, 0.00013107952211408},
    {0, 1000000, 0.99, 0, 5.29830333048937e-6, 0, 4.60515958220815e-6},
    {4, 1000000, 0.95, 1.08986641452283e-6, 1.02415567135497e-5, 1.36631951281623e-6, 9.15349544024032e-6},
    {12, 1000000000, 0.95, 6.20057512360181e-9, 2.09615849542524e-8, 6.92421252769592e-9, 1.94425692575637e-8},
};

TEST(ClopperPearson, meets_the_reference_values) {
  for (const auto& row : kClopperPearson) {
    SCOPED_TRACE(testing::Message() << row.k << " of " << row.n << " at " << row.confidence);
    const auto interval = two_sided_interval(row.k, row.n, row.confidence);
    expect_close(interval.lower, row.two_sided_lower);
    expect_close(interval.upper, row.two_sided_upper);
    expect_close(lower_bound(row.k, row.n, row.confidence), row.one_sided_lower);
    expect_close(upper_bound(row.k, row.n, row.confidence), row.one_sided_upper);
  }
}

TEST(ClopperPearson, zero_failures_meet_the_closed_form) {
  expect_close(upper_bound(0, 1, 0.95), 0.95);
  expect_close(upper_bound(0, 299, 0.99), 0.0152839042066226);
  expect_close(upper_bound(0, 2995, 0.95), 0.000999744420901142);
  expect_close(upper_bound(0, 100000, 0.999), 6.9075166990607e-5);
  expect_close(upper_bound(0, 1000000000000, 0.95), 2.9957322735495e-12);
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

TEST(ClopperPearson, refuses_what_makes_no_sense) {
  EXPECT_THROW(upper_bound(3, 2, 0.95), InvariantViolation);
  EXPECT_THROW(lower_bound(1, 2, 1.0), InvariantViolation);
  EXPECT_THROW(two_sided_interval(1, 2, 0.0), InvariantViolation);
}

TEST(UnitsNeeded, meets_the_plans_with_and_without_failures) {
  EXPECT_EQ(units_needed(0, 1e-3, 0.95), 2995u);
  EXPECT_EQ(units_needed(0, 1e-3, 0.99), 4603u);
  EXPECT_EQ(units_needed(0, 1e-5, 0.95), 299572u);
  EXPECT_EQ(units_needed(0, 1e-9, 0.95), 2995732273u);
  EXPECT_EQ(units_needed(1, 1e-3, 0.95), 4742u);
  EXPECT_EQ(units_needed(2, 1e-3, 0.95), 6294u);
  EXPECT_EQ(units_needed(10, 1e-3, 0.95), 16959u);
}

TEST(UnitsNeeded, is_the_least_number_whose_bound_meets_the_limit) {
  for (const std::uint64_t k : {0u, 1u, 7u}) {
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
}

struct Fisher {
  std::uint64_t k1, n1, k2, n2;
  double two_sided, smaller, larger;
};
constexpr Fisher kFisher[] = {
    {3, 100, 10, 100, 0.0817940529689792, 0.0408970264844896, 0.990793036884627},
    {1, 10000, 9, 10000, 0.0214536209742179, 0.0107268104871089, 0.999025633337485},
    {0, 100000, 1, 100000, 1.0, 0.5, 1.0},
    {8, 16, 1, 6, 0.333038478549314, 0.977001326846528, 0.178239716939407},
    {10, 20, 2, 22, 0.00553937099963851, 0.999654453824399, 0.00420503115231675},
    {4, 8, 1, 9, 0.131221719457014, 0.990950226244344, 0.110859728506787},
    {56, 70, 48, 80, 0.0125211297492092, 0.997875268450446, 0.00632471112989837},
    {3, 4, 1, 4, 0.485714285714286, 0.985714285714286, 0.242857142857143},
};

TEST(FisherExact, meets_the_reference_values) {
  for (const auto& row : kFisher) {
    SCOPED_TRACE(testing::Message() << row.k1 << "/" << row.n1 << " against " << row.k2 << "/" << row.n2);
    const auto result = fisher_exact(row.k1, row.n1, row.k2, row.n2);
    expect_close(result.two_sided, row.two_sided);
    expect_close(result.first_smaller, row.smaller);
    expect_close(result.first_larger, row.larger);
    const auto swapped = fisher_exact(row.k2, row.n2, row.k1, row.n1);
    expect_close(swapped.two_sided, row.two_sided);
    expect_close(swapped.first_larger, row.smaller);
  }
}

TEST(FisherExact, equal_or_empty_groups_differ_in_nothing) {
  EXPECT_EQ(fisher_exact(0, 10, 0, 10).two_sided, 1.0);
  EXPECT_EQ(fisher_exact(10, 10, 10, 10).two_sided, 1.0);
  EXPECT_EQ(fisher_exact(0, 0, 0, 0).two_sided, 1.0);
  EXPECT_EQ(fisher_exact(5, 10, 5, 10).two_sided, 1.0);
}

}  // namespace
}  // namespace fleetproof
