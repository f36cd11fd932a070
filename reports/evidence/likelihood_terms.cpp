#include "reports/evidence/likelihood_terms.hpp"

#include <boost/math/special_functions/gamma.hpp>
#include <boost/math/special_functions/log1p.hpp>
#include <cmath>

namespace fleetproof {
namespace {

constexpr double kHalfLogTwoPi = 0.91893853320467274178;
constexpr double kSeriesFrom = 20.0;  // from here on the series below is exact to the last bit

// ln Gamma(z) - ((z - 1/2) ln z - z + ln(2 pi) / 2)
double stirling_remainder(double z) {
  const double w = 1.0 / (z * z);
  return (1.0 / 12 - w * (1.0 / 360 - w * (1.0 / 1260 - w * (1.0 / 1680 - w / 1188)))) / z;
}

}  // namespace

double deviance_term(double count, double expected, double excess) {
  if (count == 0.0) return excess;
  const double share = excess / count;
  if (std::abs(share) < 0.5) return -count * boost::math::log1pmx(share);
  return count * std::log(count / expected) + excess;
}

double binomial_deviance(double failing, double units, double p) {
  const double passing = units - failing, q = 1.0 - p;
  const double excess = p < 0.5 ? units * p - failing : passing - units * q;
  return deviance_term(failing, units * p, excess) + deviance_term(passing, units * q, -excess);
}

double binomial_probability(double failing, double units, double p) {
  return std::exp(log_gamma_over_power(1.0, units) - log_gamma_over_power(1.0, failing) -
                  log_gamma_over_power(1.0, units - failing) - binomial_deviance(failing, units, p));
}

double log_gamma(double shape) { return boost::math::lgamma(shape); }

double log_gamma_over_power(double shape, double count) {
  if (count == 0.0) return log_gamma(shape);
  const double z = shape + count;
  if (z < kSeriesFrom) return log_gamma(z) - count * std::log(count) + count;
  return count * std::log1p(shape / count) - shape + (shape - 0.5) * std::log(z) + kHalfLogTwoPi +
         stirling_remainder(z);
}

}  // namespace fleetproof
