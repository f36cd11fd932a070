#pragma once

#include <gtest/gtest.h>

#include <cstdint>

namespace fleetproof::test {

// Whether chance explains `count` successes in `trials` independent trials of probability p: on neither side is the
// exact probability of a result at least as extreme below half of the risk.
testing::AssertionResult is_binomial(std::uint64_t count, std::uint64_t trials, double p, double risk = 1e-6);

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
