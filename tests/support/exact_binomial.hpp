#pragma once

#include <gtest/gtest.h>

#include <boost/math/distributions/binomial.hpp>
#include <cstdint>

namespace fleetproof::test {

// Whether `count` successes in `trials` independent trials of probability p differ from chance: the exact probability
// of a result at least as extreme, on this side, is below half of the risk.
inline testing::AssertionResult is_binomial(std::uint64_t count, std::uint64_t trials, double p, double risk = 1e-6) {
  if (p <= 0.0 || p >= 1.0) {
    const std::uint64_t only = p <= 0.0 ? 0 : trials;
    return count == only ? testing::AssertionSuccess()
                         : testing::AssertionFailure() << count << " of " << trials << " where " << only << " was sure";
  }
  const boost::math::binomial_distribution<double> law(static_cast<double>(trials), p);
  const double at_most = boost::math::cdf(law, static_cast<double>(count));
  const double at_least =
      count == 0 ? 1.0 : boost::math::cdf(boost::math::complement(law, static_cast<double>(count - 1)));
  if (at_most > 0.5 * risk && at_least > 0.5 * risk) return testing::AssertionSuccess();
  return testing::AssertionFailure() << count << " of " << trials << " is a share of "
                                     << static_cast<double>(count) / static_cast<double>(trials) << ", expected " << p
                                     << "; P(at most) = " << at_most << ", P(at least) = " << at_least;
}

// Whether independent samples follow a law: at each probability, the number at or below its quantile is binomial.
template <class Samples, class Quantile>
void expect_quantiles(const Samples& samples, Quantile quantile) {
  for (const double p : {0.001, 0.01, 0.1, 0.25, 0.5, 0.75, 0.9, 0.99, 0.999}) {
    const double bound = quantile(p);
    std::uint64_t count = 0;
    for (const double sample : samples) count += sample <= bound ? 1 : 0;
    EXPECT_TRUE(is_binomial(count, samples.size(), p)) << "at the quantile " << p << " = " << bound;
  }
}

}  // namespace fleetproof::test
