#include "reports/evidence/poisson_rate.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/reference_table.hpp"

namespace fleetproof::poisson_rate_test {
namespace {

using test::expect_close;
using test::reference_rows;

TEST(Garwood, meets_the_reference_values) {
  for (const auto& row : reference_rows("garwood")) {
    const auto k = row.count("k");
    const auto interval = two_sided_rate(k, row["exposure"], row["confidence"]);
    expect_close(interval.lower, row, "two_sided_lower");
    expect_close(interval.upper, row, "two_sided_upper");
    expect_close(lower_rate(k, row["exposure"], row["confidence"]), row, "one_sided_lower");
    expect_close(upper_rate(k, row["exposure"], row["confidence"]), row, "one_sided_upper");
  }
}

TEST(Garwood, hours_needed_meet_the_reference_values) {
  for (const auto& row : reference_rows("hours_needed")) {
    const auto hours = [&](std::uint64_t events) {
      return exposure_needed(events, row["rate_limit_per_hour"], row["confidence"]);
    };
    expect_close(hours(0), row, "hours_if_0_events");
    expect_close(hours(1), row, "hours_if_1_event");
    expect_close(hours(2), row, "hours_if_2_events");
    expect_close(hours(5), row, "hours_if_5_events");
  }
}

TEST(Garwood, after_the_hours_needed_the_bound_is_the_limit) {
  for (const std::uint64_t events : {0U, 1U, 30U, 100000U})
    expect_close(upper_rate(events, exposure_needed(events, 1e-6, 0.99), 0.99), 1e-6, "1e-6");
}

TEST(RateRatio, meets_the_reference_values) {
  for (const auto& row : reference_rows("poisson_rate_ratio")) {
    const auto result = rate_ratio({row.count("k1"), row["T1"]}, {row.count("k2"), row["T2"]}, row["confidence"]);
    expect_close(result.ratio, row, "ratio_rate1_over_rate2");
    expect_close(result.interval.lower, row, "lower");
    expect_close(result.interval.upper, row, "upper");
    expect_close(result.two_sided, row, "p_two_sided_minlike");
    expect_close(result.first_smaller, row, "p_one_sided_rate1_lower");
  }
}

TEST(RateRatio, swapped_exposures_give_the_inverse) {
  const auto one = rate_ratio({4, 1000}, {90, 3000}, 0.99), other = rate_ratio({90, 3000}, {4, 1000}, 0.99);
  expect_close(one.ratio * other.ratio, 1.0, "the ratio");
  expect_close(one.interval.lower * other.interval.upper, 1.0, "one end");
  expect_close(one.interval.upper * other.interval.lower, 1.0, "the other end");
  expect_close(one.two_sided, other.two_sided, "the test");
}

TEST(RateRatio, without_events_nothing_is_known) {
  const auto none = rate_ratio({0, 10}, {0, 20}, 0.95);
  EXPECT_TRUE(std::isnan(none.ratio));
  EXPECT_EQ(none.interval.lower, 0.0);
  EXPECT_TRUE(std::isinf(none.interval.upper));
  EXPECT_EQ(none.two_sided, 1.0);
  EXPECT_TRUE(std::isinf(rate_ratio({3, 10}, {0, 20}, 0.95).interval.upper));
}

}  // namespace
}  // namespace fleetproof::poisson_rate_test
