#pragma once

#include <cstdint>
#include <optional>

#include "reports/evidence/binomial.hpp"

namespace fleetproof {

// Confidence sequences: intervals that hold for all numbers of trials at once, with the stated confidence. One may
// look after every trial, and stop or extend the campaign for any reason. A mixture of likelihood ratios M is a
// martingale with mean 1 at the true value, so it ever exceeds 1 / risk with a probability of at most the risk (Ville
// 1939; Robbins 1970; Howard, Ramdas, McAuliffe and Sekhon 2021). The sequence is the set of values with
// M < 1 / risk. The prior is part of the plan, fixed before the first trial.

// The weight of each probability in the mixture. The default is nearly flat over the decades of small probabilities.
struct BetaPrior {
  double a = 0.05, b = 1.0;  // both > 0
};

// ln M(p) = ln( B(a + failing, b + units - failing) / (B(a, b) p^failing (1 - p)^(units - failing)) ).
// Requires: failing <= units, 0 < p < 1.
double log_mixture(std::uint64_t failing, std::uint64_t units, double p, const BetaPrior& prior);

// The beta-binomial sequence after `failing` of `units` trials failed. Requires: failing <= units.
RateInterval any_time_interval(std::uint64_t failing, std::uint64_t units, Confidence confidence,
                               const BetaPrior& prior = {});

// The smallest number of trials at which the sequence lies below `limit` if `failing` of them fail. Absent if there is
// none below 10^15. Requires: 0 < limit < 1.
std::optional<std::uint64_t> any_time_units_needed(std::uint64_t failing, double limit, Confidence confidence,
                                                   const BetaPrior& prior = {});

struct GammaPrior {
  double shape = 0.05, rate = 1.0;  // both > 0; the rate in the unit of the exposure
};

// The Gamma-Poisson sequence of a rate: ln M(r) = ln( Gamma(shape + events) / Gamma(shape) * rate^shape / (rate +
// exposure)^(shape + events) * r^-events * e^(r exposure) ). It also holds if the exposure of a run ends at its first
// event. Requires: exposure > 0.
RateInterval any_time_rate(std::uint64_t events, double exposure, Confidence confidence, const GammaPrior& prior = {});

}  // namespace fleetproof
