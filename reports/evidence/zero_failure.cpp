#include "reports/evidence/zero_failure.hpp"

#include <cmath>

#include "core/base/error.hpp"

namespace fleetproof {

double zero_failure_bound(std::uint64_t units, Confidence confidence) {
  ensure(units > 0, "a bound needs trials");
  return -std::expm1(std::log(confidence.risk()) / static_cast<double>(units));
}

double zero_failure_poisson_bound(std::uint64_t units, Confidence confidence) {
  ensure(units > 0, "a bound needs trials");
  return -std::log(confidence.risk()) / static_cast<double>(units);
}

double zero_failure_probability(std::uint64_t units, double p) {
  return std::exp(static_cast<double>(units) * std::log1p(-p));
}

std::optional<std::uint64_t> zero_failure_units(double limit, Confidence confidence) {
  ensure(limit > 0.0 && limit < 1.0, "a limit lies between 0 and 1");
  constexpr double kMostUnits = 1e15;
  constexpr double kTie = 1.0 - 1e-15;  // 0.9 * 0.9 is a risk of 0.81, whatever the last bits say
  const double units = std::ceil(std::log(confidence.risk()) / std::log1p(-limit) * kTie);
  if (units > kMostUnits) return std::nullopt;
  return static_cast<std::uint64_t>(units);
}

}  // namespace fleetproof
