#pragma once

namespace fleetproof {

// The parts of logarithms of likelihood ratios that are small although their own parts are large. Each is computed
// without cancellation, so that counts of 10^9 and rates of 10^-9 keep their digits.

// count ln(count / expected) + expected - count, which is never negative (Loader 2000: the deviance part of a binomial
// or Poisson probability). `excess` is expected - count; the caller knows it more exactly than a difference here would
// be. Requires: count >= 0, expected > 0 unless count is 0.
double deviance_term(double count, double expected, double excess);

// The deviance of `failing` failures in `units` trials at the probability p: the logarithm of the likelihood at the
// observed rate, minus that at p. Requires: 0 <= failing <= units, 0 < p < 1.
double binomial_deviance(double failing, double units, double p);

// The binomial probability of exactly `failing` failures (Loader 2000). The same requirements.
double binomial_probability(double failing, double units, double p);

// ln Gamma(shape + count) - (count ln(count) - count), by Stirling's series for large arguments.
// Requires: shape > 0, count >= 0.
double log_gamma_over_power(double shape, double count);

// ln Gamma(shape). Requires: shape > 0.
double log_gamma(double shape);

}  // namespace fleetproof
