#include "reports/evidence/poisson_rate.hpp"

#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <limits>

#include "core/base/error.hpp"
#include "reports/evidence/tail_sums.hpp"

namespace fleetproof {
namespace {

// The mean of a Poisson count that is so large that `events` or fewer have a probability of the risk.
double upper_mean(std::uint64_t events, Confidence confidence) {
  if (events == 0) return -std::log(confidence.risk());
  return boost::math::gamma_q_inv(static_cast<double>(events) + 1.0, confidence.risk());
}

double lower_mean(std::uint64_t events, Confidence confidence) {
  if (events == 0) return 0.0;
  if (events == 1) return -std::log1p(-confidence.risk());
  return boost::math::gamma_p_inv(static_cast<double>(events), confidence.risk());
}

}  // namespace

double lower_rate(std::uint64_t events, double exposure, Confidence confidence) {
  ensure(exposure > 0.0, "a rate needs exposure");
  return lower_mean(events, confidence) / exposure;
}

double upper_rate(std::uint64_t events, double exposure, Confidence confidence) {
  ensure(exposure > 0.0, "a rate needs exposure");
  return upper_mean(events, confidence) / exposure;
}

RateInterval two_sided_rate(std::uint64_t events, double exposure, Confidence confidence) {
  const Confidence half = confidence.shared(2.0);
  return {lower_rate(events, exposure, half), upper_rate(events, exposure, half)};
}

double exposure_needed(std::uint64_t events, double limit, Confidence confidence) {
  ensure(limit > 0.0, "no exposure shows a rate of zero");
  return upper_mean(events, confidence) / limit;
}

RateRatio rate_ratio(const CountedEvents& first, const CountedEvents& second, Confidence confidence) {
  ensure(first.exposure > 0.0 && second.exposure > 0.0, "a rate needs exposure");
  const std::uint64_t all = first.events + second.events;
  const double scale = second.exposure / first.exposure;
  RateRatio result;
  result.ratio = static_cast<double>(first.events) / static_cast<double>(second.events) * scale;
  // 1 - q is the share of the second, whose bounds are exact where a difference would not be.
  const RateInterval share1 = two_sided_interval(first.events, all, confidence),
                     share2 = two_sided_interval(second.events, all, confidence);
  result.interval = {share1.lower / share2.upper * scale, share1.upper / share2.lower * scale};
  const TailSums sums = tail_sums(binomial_law(all, first.exposure / second.exposure), first.events);
  result.two_sided = sums.no_likelier;
  result.first_smaller = sums.at_most;
  return result;
}

}  // namespace fleetproof
