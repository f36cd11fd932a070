// Fisher's and McNemar's exact tests, and the guaranteed difference of two releases.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "core/base/error.hpp"
#include "reports/evidence/fisher.hpp"
#include "reports/evidence/paired.hpp"
#include "tests/support/reference_table.hpp"

namespace fleetproof {
namespace {

using test::expect_close;
using test::reference_rows;

TEST(FisherExact, meets_the_reference_values) {
  for (const auto& row : reference_rows("fisher")) {
    const auto k1 = row.count("k1"), n1 = row.count("n1"), k2 = row.count("k2"), n2 = row.count("n2");
    const auto result = fisher_exact(k1, n1, k2, n2);
    expect_close(result.two_sided, row, "p_two_sided");
    expect_close(result.first_smaller, row, "p_one_sided_rate1_smaller");
    expect_close(result.first_larger, row, "p_one_sided_rate1_larger");
    expect_close(result.mid_two_sided, row, "p_mid_two_sided");
    const auto swapped = fisher_exact(k2, n2, k1, n1);
    expect_close(swapped.two_sided, row, "p_two_sided");
    expect_close(swapped.first_larger, row, "p_one_sided_rate1_smaller");
  }
}

TEST(FisherExact, equal_or_empty_groups_differ_in_nothing) {
  EXPECT_EQ(fisher_exact(0, 10, 0, 10).two_sided, 1.0);
  EXPECT_EQ(fisher_exact(10, 10, 10, 10).two_sided, 1.0);
  EXPECT_EQ(fisher_exact(0, 0, 0, 0).two_sided, 1.0);
  EXPECT_EQ(fisher_exact(5, 10, 5, 10).two_sided, 1.0);
  EXPECT_THROW(fisher_exact(11, 10, 0, 10), InvariantViolation);
}

TEST(McNemar, meets_the_reference_values) {
  for (const auto& row : reference_rows("mcnemar")) {
    const auto result = mcnemar_exact(row.count("b_only_old_violates"), row.count("c_only_new_violates"));
    expect_close(result.two_sided, row, "p_exact_two_sided");
    expect_close(result.mid_two_sided, row, "p_mid_two_sided");
    expect_close(result.new_worse, row, "p_exact_one_sided_new_worse");
  }
}

TEST(PairedDifference, meets_the_reference_values) {
  for (const auto& row : reference_rows("paired_difference")) {
    const PairedCounts counts{row.count("both"), row.count("only_old"), row.count("only_new"), row.count("neither")};
    const auto result = paired_difference(counts, row["confidence"]);
    expect_close(result.difference, row, "delta_new_minus_old");
    expect_close(result.lower, row, "split_exact_lower");
    expect_close(result.upper, row, "split_exact_upper");
    expect_close(result.one_sided_upper, row, "split_exact_one_sided_upper");
  }
}

double factorial(std::uint64_t n) { return n == 0 ? 1.0 : static_cast<double>(n) * factorial(n - 1); }

// The probabilities of all outcomes of a few pairs, summed where the statement is true.
TEST(PairedDifference, covers_the_true_difference) {
  constexpr std::uint64_t kPairs = 12;
  for (const auto& [old_only, new_only] : {std::pair{0.05, 0.05}, {0.3, 0.1}, {0.0, 0.25}, {0.02, 0.6}, {0.5, 0.5}}) {
    double covered = 0.0, below_upper = 0.0;
    for (std::uint64_t b = 0; b <= kPairs; ++b) {
      for (std::uint64_t c = 0; b + c <= kPairs; ++c) {
        const auto rest = kPairs - b - c;
        const double probability = factorial(kPairs) / factorial(b) / factorial(c) / factorial(rest) *
                                   std::pow(old_only, b) * std::pow(new_only, c) *
                                   std::pow(1.0 - old_only - new_only, rest);
        const auto result = paired_difference({0, b, c, rest}, 0.9);
        const double truth = new_only - old_only;
        if (result.lower <= truth && truth <= result.upper) covered += probability;
        if (truth <= result.one_sided_upper) below_upper += probability;
      }
    }
    EXPECT_GE(covered, 0.9 - 1e-12) << old_only << " " << new_only;
    EXPECT_GE(below_upper, 0.9 - 1e-12) << old_only << " " << new_only;
  }
}

}  // namespace
}  // namespace fleetproof
