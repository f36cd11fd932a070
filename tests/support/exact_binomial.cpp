#include "tests/support/exact_binomial.hpp"

#include <boost/math/distributions/binomial.hpp>

namespace fleetproof::test {

testing::AssertionResult is_binomial(std::uint64_t count, std::uint64_t trials, double p, double risk) {
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

}  // namespace fleetproof::test
