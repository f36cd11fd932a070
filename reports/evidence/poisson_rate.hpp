#pragma once

#include <cstdint>

#include "reports/evidence/binomial.hpp"

namespace fleetproof {

// Exact statements about a rate, after `events` were counted in `exposure` hours (or any other unit).
// Requires: exposure > 0, fixed beforehand, and events that come one by one at a constant rate (Poisson). Incidents of
// one run that follow from each other are one event.

// Garwood (1936): quantiles of Gamma(events) and Gamma(events + 1), divided by the exposure. Two-sided: half of the
// risk on each side. One-sided: the whole risk on one side.
RateInterval two_sided_rate(std::uint64_t events, double exposure, Confidence confidence);
double lower_rate(std::uint64_t events, double exposure, Confidence confidence);
double upper_rate(std::uint64_t events, double exposure, Confidence confidence);

// The exposure whose one-sided upper bound equals the limit if `events` are counted. Requires: limit > 0.
double exposure_needed(std::uint64_t events, double limit, Confidence confidence);

// Two rates compared: given their sum, the events of the first are binomial with q = exposure1 / (exposure1 +
// exposure2) if the rates are equal (conditional exact test). The Clopper-Pearson interval of q becomes that of the
// ratio.
struct RateRatio {
  double ratio = 0.0;          // rate 1 divided by rate 2; not a number without events, infinite if events2 is 0
  RateInterval interval;       // two-sided; [0, infinity] without events
  double two_sided = 1.0;      // the probability of all divisions that are at most as likely as the observed one
  double first_smaller = 1.0;  // the probability of `events1` or fewer events in the first exposure
};
struct CountedEvents {
  std::uint64_t events = 0;
  double exposure = 1.0;
};
RateRatio rate_ratio(const CountedEvents& first, const CountedEvents& second, Confidence confidence);

}  // namespace fleetproof
