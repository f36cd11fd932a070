#include "reports/evidence/binomial.hpp"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>

#include "core/base/error.hpp"
#include "reports/evidence/likelihood_terms.hpp"
#include "reports/evidence/zero_failure.hpp"

namespace fleetproof {
namespace {

constexpr std::uint64_t kMostUnits = 1'000'000'000'000'000;

// Whether sums over a law with this variance are short enough.
bool is_short(double n, double p) {
  constexpr double kMostVariance = 1e8;
  return n * p * (1.0 - p) <= kMostVariance;
}

// The sum of a probability and those beyond it, each the one before times a ratio. The ratios fall.
template <class Ratio>
double sum_from(double first, double last, double step, const Ratio& ratio) {
  double sum = 1.0, term = 1.0;
  for (double x = first; x != last; x += step) {
    term *= ratio(x);
    sum += term;
    if (term < 1e-18 * sum) break;
  }
  return sum;
}

// P(X <= k) from the side where the probabilities fall.
double summed_at_most(double k, double n, double p) {
  const double odds = p / (1.0 - p);
  if (k <= n * p)
    return binomial_probability(k, n, p) * sum_from(k, 0.0, -1.0, [&](double x) { return x / (n - x + 1.0) / odds; });
  return 1.0 - binomial_probability(k + 1.0, n, p) *
                   sum_from(k + 1.0, n, 1.0, [&](double x) { return (n - x) / (x + 1.0) * odds; });
}

// One step of Newton's method towards P(X <= k) = risk. For more than 10^8 trials the inverse beta function is good to
// 11 digits only.
double polished(double p, double k, double n, double risk) {
  if (p >= 1.0 || !is_short(n, p)) return p;
  const double slope = -(n - k) / (1.0 - p) * binomial_probability(k, n, p);
  const double better = p - (summed_at_most(k, n, p) - risk) / slope;
  return better > 0.0 && better < 1.0 ? better : p;
}

}  // namespace

// Both bounds have closed forms at the edges. They are exact where the inverse beta function loses digits, and the
// edges are the usual case.
double lower_bound(std::uint64_t failing, std::uint64_t units, Confidence confidence) {
  ensure(failing <= units, "no more trials fail than there are");
  if (failing == 0) return 0.0;
  const auto k = static_cast<double>(failing), n = static_cast<double>(units);
  if (failing == units) return std::exp(std::log(confidence.risk()) / n);
  return boost::math::ibeta_inv(k, n - k + 1.0, confidence.risk());
}

double upper_bound(std::uint64_t failing, std::uint64_t units, Confidence confidence) {
  ensure(failing <= units, "no more trials fail than there are");
  if (failing == units) return 1.0;
  if (failing == 0) return zero_failure_bound(units, confidence);
  const auto k = static_cast<double>(failing), n = static_cast<double>(units);
  return polished(boost::math::ibetac_inv(k + 1.0, n - k, confidence.risk()), k, n, confidence.risk());
}

RateInterval two_sided_interval(std::uint64_t failing, std::uint64_t units, Confidence confidence) {
  const Confidence half = confidence.shared(2.0);
  return {lower_bound(failing, units, half), upper_bound(failing, units, half)};
}

double probability_of_at_most(std::uint64_t failing, std::uint64_t units, double p) {
  if (failing >= units) return 1.0;
  if (failing == 0) return zero_failure_probability(units, p);
  const auto k = static_cast<double>(failing), n = static_cast<double>(units);
  if (p <= 0.0 || p >= 1.0) return p <= 0.0 ? 1.0 : 0.0;
  return is_short(n, p) ? summed_at_most(k, n, p) : boost::math::ibetac(k + 1.0, n - k, p);
}

std::optional<std::uint64_t> units_needed(std::uint64_t failing, double limit, Confidence confidence) {
  if (!(limit > 0.0)) return std::nullopt;
  if (limit >= 1.0) return failing;
  if (failing == 0) return zero_failure_units(limit, confidence);
  const auto enough = [&](std::uint64_t units) {
    return probability_of_at_most(failing, units, limit) <= confidence.risk();
  };
  std::uint64_t too_few = failing, plenty = failing * 2;
  while (!enough(plenty)) {
    too_few = plenty;
    plenty *= 2;
    if (plenty > kMostUnits) return std::nullopt;
  }
  while (plenty - too_few > 1) {
    const auto middle = too_few + (plenty - too_few) / 2;
    (enough(middle) ? plenty : too_few) = middle;
  }
  return plenty;
}

}  // namespace fleetproof
