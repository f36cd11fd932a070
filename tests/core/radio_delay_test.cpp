// Delays and copies against their closed forms, on a million messages each.
#include <gtest/gtest.h>

#include <cmath>

#include "core/radio/radio.hpp"
#include "tests/support/exact_binomial.hpp"

namespace fleetproof::radio_delay_test {
namespace {

using DelayModel = RadioSetup::DelayModel;
using test::expect_quantiles;

constexpr int kMessages = 1'000'000;
const AgvId kA{0U}, kB{1U};

std::vector<double> delays_s(const RadioSetup& setup) {
  Radio radio(setup, 31);
  std::vector<double> found;
  for (int i = 0; i < kMessages; ++i)
    found.push_back(to_seconds(radio.delivery(kA, kB, at_ns(i * 1'000'003LL), 0).delay));
  return found;
}

// Of a heavy-tailed delay without cap, from the definition: a Lomax law of this shape whose median is where it is asked
// to be.
double heavy_tail_quantile(double delay_s, double min_share, double median_share, double shape, double p) {
  const double scale = (median_share - min_share) / (std::pow(2.0, 1.0 / shape) - 1.0);
  return delay_s * (min_share + scale * (std::pow(1.0 - p, -1.0 / shape) - 1.0));
}

TEST(RadioDelay, ConstantIsConstant) {
  for (const double delay_s : delays_s({.delay_s = 2.0})) ASSERT_EQ(delay_s, 2.0);
}

TEST(RadioDelay, UniformIsUniform) {
  const auto samples = delays_s({.delay_s = 2.0, .delay_model = DelayModel::Uniform});
  expect_quantiles(samples, [](double p) { return 2.0 * p; });
  EXPECT_LT(std::ranges::max(samples), 2.0);
}

TEST(RadioDelay, HeavyTailHasItsMinimumMedianAndTail) {
  for (const double shape : {0.5, 1.5, 4.0}) {
    const auto samples =
        delays_s({.delay_s = 2.0,
                  .delay_model = DelayModel::HeavyTail,
                  .delay_tail = {.min_share = 0.1, .median_share = 0.3, .shape = shape, .cap_share = 0.0}});
    expect_quantiles(samples, [&](double p) { return heavy_tail_quantile(2.0, 0.1, 0.3, shape, p); });
    EXPECT_GE(std::ranges::min(samples), 0.2);
  }
}

TEST(RadioDelay, ACapHoldsAndTakesWhatIsBeyondIt) {
  const auto samples = delays_s({.delay_s = 2.0, .delay_model = DelayModel::HeavyTail});
  EXPECT_EQ(std::ranges::max(samples), 2.0);
  const double scale = 0.1 / (std::pow(2.0, 1.0 / 1.5) - 1.0);
  const double beyond = std::pow(1.0 + 0.9 / scale, -1.5);
  EXPECT_TRUE(test::is_binomial(static_cast<std::uint64_t>(std::ranges::count(samples, 2.0)), kMessages, beyond));
  const auto median = heavy_tail_quantile(2.0, 0.1, 0.2, 1.5, 0.5);
  EXPECT_DOUBLE_EQ(median, 0.4);
  EXPECT_TRUE(test::is_binomial(
      static_cast<std::uint64_t>(std::ranges::count_if(samples, [&](double d) { return d <= median; })), kMessages,
      0.5));
}

TEST(RadioCopies, HaveTheirShareAndADelayOfTheirOwn) {
  Radio with({.loss = 0.4, .delay_s = 2.0, .delay_model = DelayModel::Uniform, .duplicates = 0.03}, 8);
  Radio without({.loss = 0.4, .delay_s = 2.0, .delay_model = DelayModel::Uniform}, 8);
  std::vector<double> copies_s;
  std::uint64_t copy_comes_first = 0, copies_of_received = 0, received = 0;
  for (int i = 0; i < kMessages; ++i) {
    const SimTime at = at_ns(i * 1'000'003LL);
    const Delivery delivery = with.delivery(kA, kB, at, 0), alone = without.delivery(kA, kB, at, 0);
    ASSERT_EQ(delivery.lost, alone.lost);  // copies change nothing about the originals
    ASSERT_EQ(delivery.delay, alone.delay);
    ASSERT_FALSE(alone.copy_delay.has_value());
    received += delivery.lost ? 0 : 1;
    if (!delivery.copy_delay) continue;
    copies_s.push_back(to_seconds(*delivery.copy_delay));
    copy_comes_first += *delivery.copy_delay < delivery.delay ? 1 : 0;
    copies_of_received += delivery.lost ? 0 : 1;
  }
  EXPECT_TRUE(test::is_binomial(copies_s.size(), kMessages, 0.03));
  EXPECT_TRUE(test::is_binomial(copies_of_received, received, 0.03));
  EXPECT_TRUE(test::is_binomial(copy_comes_first, copies_s.size(), 0.5));
  expect_quantiles(copies_s, [](double p) { return 2.0 * p; });
}

}  // namespace
}  // namespace fleetproof::radio_delay_test
