#pragma once

#include <cstdint>
#include <functional>

namespace fleetproof {

// A law on the integers from `least` to `most`, given by the ratios of neighbours. The probabilities must rise up to
// `mode` and fall after it.
struct RatioLaw {
  std::uint64_t least = 0, most = 0, mode = 0;
  std::function<double(double)> ratio_up;  // of x: the probability of x + 1 divided by that of x
};

// Binomial law: failures in `units` independent trials, each with `odds` of failing, p / (1 - p). Odds keep the digits
// of a probability near 1. Requires: odds > 0.
RatioLaw binomial_law(std::uint64_t units, double odds);

// Hypergeometric law: failures in the first group, given both sizes and the failures of both.
// Requires: failures <= units1 + units2.
RatioLaw hypergeometric_law(std::uint64_t units1, std::uint64_t units2, std::uint64_t failures);

struct TailSums {
  double at_most = 0.0, at_least = 0.0;  // P(X <= observed), P(X >= observed)
  double exactly = 0.0;                  // P(X = observed)
  double no_likelier = 0.0;              // the probability of all values that are at most as likely as the observed one
};

// Sums the probabilities outwards from the mode, and divides by their total. This needs no factorial, and small tails
// keep their digits. Time grows with the standard deviation of the law. Requires: least <= observed <= most.
TailSums tail_sums(const RatioLaw& law, std::uint64_t observed);

}  // namespace fleetproof
