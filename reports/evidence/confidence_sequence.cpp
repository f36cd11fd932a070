#include "reports/evidence/confidence_sequence.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/error.hpp"
#include "reports/evidence/likelihood_terms.hpp"

namespace fleetproof {
namespace {

// The edge of a set of real numbers between a number inside and a number outside: the first double outside, so that an
// interval with these ends holds the whole set. Requires: `is_inside` changes once between the two.
template <class IsInside>
double edge_between(double inside, double outside, const IsInside& is_inside) {
  for (;;) {
    const double middle = inside + (outside - inside) / 2.0;
    if (middle == inside || middle == outside) return outside;
    (is_inside(middle) ? inside : outside) = middle;
  }
}

// ln M at the observed rate, where the deviance is 0.
double log_mixture_at_rate(double k, double n, const BetaPrior& prior) {
  const double log_beta = log_gamma(prior.a) + log_gamma(prior.b) - log_gamma(prior.a + prior.b);
  return log_gamma_over_power(prior.a, k) + log_gamma_over_power(prior.b, n - k) -
         log_gamma_over_power(prior.a + prior.b, n) - log_beta;
}

}  // namespace

double log_mixture(std::uint64_t failing, std::uint64_t units, double p, const BetaPrior& prior) {
  ensure(failing <= units && p > 0.0 && p < 1.0, "failing trials are trials, and a trial can fail and can pass");
  const auto k = static_cast<double>(failing), n = static_cast<double>(units);
  return log_mixture_at_rate(k, n, prior) + binomial_deviance(k, n, p);
}

RateInterval any_time_interval(std::uint64_t failing, std::uint64_t units, Confidence confidence,
                               const BetaPrior& prior) {
  ensure(failing <= units && prior.a > 0.0 && prior.b > 0.0, "failing trials are trials, and a prior is positive");
  if (units == 0) return {};
  const auto k = static_cast<double>(failing), n = static_cast<double>(units);
  // The largest deviance in the set.
  const double reach = -std::log(confidence.risk()) - log_mixture_at_rate(k, n, prior);
  if (failing == 0) return {0.0, -std::expm1(-reach / n)};
  if (failing == units) return {std::exp(-reach / n), 1.0};
  const auto is_inside = [&](double p) { return binomial_deviance(k, n, p) < reach; };
  return {edge_between(k / n, 0.0, is_inside), edge_between(k / n, 1.0, is_inside)};
}

std::optional<std::uint64_t> any_time_units_needed(std::uint64_t failing, double limit, Confidence confidence,
                                                   const BetaPrior& prior) {
  ensure(limit > 0.0 && limit < 1.0, "a limit lies between 0 and 1");
  constexpr double kMostUnits = 1e15;
  // From here on the limit is above the observed rate, and M at the limit rises with every trial that passes.
  const double k = static_cast<double>(failing);
  const double first = std::max({k, std::floor(k / limit) + 1.0, (prior.a + k) / limit - prior.a - prior.b});
  if (!(first < kMostUnits)) return std::nullopt;
  const auto enough = [&](std::uint64_t units) {
    return log_mixture(failing, units, limit, prior) >= -std::log(confidence.risk());
  };
  auto plenty = static_cast<std::uint64_t>(first), too_few = plenty - 1;
  while (!enough(plenty)) {
    too_few = plenty;
    plenty *= 2;
    if (static_cast<double>(plenty) > kMostUnits) return std::nullopt;
  }
  while (plenty - too_few > 1) {
    const auto middle = too_few + (plenty - too_few) / 2;
    (enough(middle) ? plenty : too_few) = middle;
  }
  return plenty;
}

RateInterval any_time_rate(std::uint64_t events, double exposure, Confidence confidence, const GammaPrior& prior) {
  ensure(exposure > 0.0 && prior.shape > 0.0 && prior.rate > 0.0, "exposure and prior are positive");
  const auto count = static_cast<double>(events);
  const double at_rate = log_gamma_over_power(prior.shape, count) - log_gamma(prior.shape) -
                         prior.shape * std::log1p(exposure / prior.rate) - count * std::log1p(prior.rate / exposure);
  const double reach = -std::log(confidence.risk()) - at_rate;
  if (events == 0) return {0.0, reach / exposure};
  // In expected events, so that the search does not depend on the unit of time.
  const auto is_inside = [&](double expected) { return deviance_term(count, expected, expected - count) < reach; };
  double outside = 2.0 * count;
  while (is_inside(outside)) outside *= 2.0;
  return {edge_between(count, 0.0, is_inside) / exposure, edge_between(count, outside, is_inside) / exposure};
}

}  // namespace fleetproof
