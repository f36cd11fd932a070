#pragma once

#include <cstdint>
#include <optional>

#include "reports/evidence/confidence.hpp"

namespace fleetproof {

// What trials without any failure show. Requires: a number of trials that was fixed beforehand, or a campaign that
// ends at its first failure.

// The upper bound on the probability of failure: 1 - risk^(1/units), the Clopper-Pearson bound at zero failures.
// Requires: units > 0.
double zero_failure_bound(std::uint64_t units, Confidence confidence);

// -ln(risk) / units: the same for a rate per unit (Poisson); always larger. Requires: units > 0.
double zero_failure_poisson_bound(std::uint64_t units, Confidence confidence);

// The probability (1 - p)^units that no trial fails. Requires: 0 <= p <= 1.
double zero_failure_probability(std::uint64_t units, double p);

// The smallest number of trials with (1 - limit)^units <= risk: ln(risk) / ln(1 - limit), rounded up. Absent if there
// is none below 10^15. Requires: 0 < limit < 1.
std::optional<std::uint64_t> zero_failure_units(double limit, Confidence confidence);

}  // namespace fleetproof
