#include "reports/evidence/binomial.hpp"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>

#include "core/base/error.hpp"
#include "reports/evidence/zero_failure.hpp"

namespace fleetproof {
namespace {

constexpr std::uint64_t kMostUnits = 1'000'000'000'000'000;

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
  return boost::math::ibetac_inv(k + 1.0, n - k, confidence.risk());
}

RateInterval two_sided_interval(std::uint64_t failing, std::uint64_t units, Confidence confidence) {
  const Confidence half = confidence.shared(2.0);
  return {lower_bound(failing, units, half), upper_bound(failing, units, half)};
}

double probability_of_at_most(std::uint64_t failing, std::uint64_t units, double p) {
  if (failing >= units) return 1.0;
  if (failing == 0) return zero_failure_probability(units, p);
  return boost::math::ibetac(static_cast<double>(failing) + 1.0, static_cast<double>(units - failing), p);
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
