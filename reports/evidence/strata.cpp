#include "reports/evidence/strata.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/error.hpp"
#include "reports/evidence/binomial.hpp"
#include "reports/evidence/likelihood_terms.hpp"

namespace fleetproof {
namespace {

// The solution 1 - p_c = mu units_c / weight_c over some strata, written so that no digits cancel: with W and N the
// sums of weights and units, N mu / W = exp(ln(risk) / N - D), where D is the divergence of the shares of units from
// the shares of weight.
struct Solution {
  double weight = 0.0, units = 0.0;  // sums
  double log_scale = 0.0;            // ln(N mu / W)

  double weighted_sum() const { return -weight * std::expm1(log_scale); }
  // Whether the stratum would get a negative probability of failure.
  bool excludes(const Stratum& stratum) const {
    return std::exp(log_scale) * weight * static_cast<double>(stratum.units) >= stratum.weight * units;
  }
};

Solution solve(const std::vector<Stratum>& strata, Confidence confidence) {
  Solution solution;
  for (const Stratum& stratum : strata) {
    solution.weight += stratum.weight;
    solution.units += static_cast<double>(stratum.units);
  }
  double divergence = 0.0;
  for (const Stratum& stratum : strata) {
    const double of_units = static_cast<double>(stratum.units) / solution.units,
                 of_weight = stratum.weight / solution.weight;
    divergence += deviance_term(of_units, of_weight, of_weight - of_units);
  }
  solution.log_scale = std::log(confidence.risk()) / solution.units - divergence;
  return solution;
}

}  // namespace

double stratified_zero_failure_bound(const std::vector<Stratum>& strata, Confidence confidence) {
  // The strata that may fail, the one with most units for its weight last.
  std::vector<Stratum> active;
  for (const Stratum& stratum : strata) {
    ensure(stratum.failing == 0, "the exact bound holds without failures");
    if (stratum.weight > 0.0) active.push_back(stratum);
  }
  ensure(!active.empty(), "a profile has a weight");
  std::ranges::sort(active, {}, [](const Stratum& s) { return static_cast<double>(s.units) / s.weight; });
  if (active.back().units == 0) return solve(active, confidence).weight;
  while (active.size() > 1 && solve(active, confidence).excludes(active.back())) {
    if (active[active.size() - 2].units == 0) break;
    active.pop_back();
  }
  return solve(active, confidence).weighted_sum();
}

double stratified_bound(const std::vector<Stratum>& strata, Confidence confidence) {
  const Confidence each = confidence.shared(static_cast<double>(strata.size()));
  double sum = 0.0;
  for (const Stratum& stratum : strata) sum += stratum.weight * upper_bound(stratum.failing, stratum.units, each);
  return sum;
}

double pooled_bound(const std::vector<Stratum>& strata, Confidence confidence) {
  std::uint64_t failing = 0, units = 0;
  for (const Stratum& stratum : strata) {
    failing += stratum.failing;
    units += stratum.units;
  }
  return upper_bound(failing, units, confidence);
}

}  // namespace fleetproof
