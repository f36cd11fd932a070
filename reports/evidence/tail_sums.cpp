#include "reports/evidence/tail_sums.hpp"

#include <algorithm>

#include "core/base/error.hpp"

namespace fleetproof {
namespace {

// Two values of equal probability differ by rounding.
constexpr double kTie = 1.0 + 1e-7;

// Beyond this share of the largest probability nothing counts. Smaller doubles lose digits, and do not fall to 0.
constexpr double kSmallest = 1e-300;

template <class Visit>
void for_each_weight(const RatioLaw& law, const Visit& visit) {
  double weight = 1.0;
  visit(law.mode, weight);
  for (auto x = law.mode; x < law.most && weight > kSmallest; ++x)
    visit(x + 1, weight *= law.ratio_up(static_cast<double>(x)));
  weight = 1.0;
  for (auto x = law.mode; x > law.least && weight > kSmallest; --x)
    visit(x - 1, weight /= law.ratio_up(static_cast<double>(x - 1)));
}

}  // namespace

RatioLaw binomial_law(std::uint64_t units, double odds) {
  ensure(odds > 0.0, "a trial can fail");
  const auto n = static_cast<double>(units);
  const auto mode = std::min(units, static_cast<std::uint64_t>((n + 1.0) * (odds / (1.0 + odds))));
  return {0, units, mode, [n, odds](double x) { return (n - x) / (x + 1.0) * odds; }};
}

RatioLaw hypergeometric_law(std::uint64_t units1, std::uint64_t units2, std::uint64_t failures) {
  ensure(failures <= units1 + units2, "no more trials fail than there are");
  const auto n1 = static_cast<double>(units1), n2 = static_cast<double>(units2), k = static_cast<double>(failures);
  const auto least = failures > units2 ? failures - units2 : 0;
  const auto most = std::min(failures, units1);
  const auto mode = std::clamp(static_cast<std::uint64_t>((k + 1.0) * (n1 + 1.0) / (n1 + n2 + 2.0)), least, most);
  return {least, most, mode, [n1, n2, k](double x) { return (k - x) * (n1 - x) / ((x + 1.0) * (n2 - k + x + 1.0)); }};
}

TailSums tail_sums(const RatioLaw& law, std::uint64_t observed) {
  ensure(law.least <= observed && observed <= law.most, "an observation is one of the possible values");
  double weight_observed = 0.0;
  for_each_weight(law,
                  [&](std::uint64_t x, double weight) { weight_observed = x == observed ? weight : weight_observed; });
  double all = 0.0;
  TailSums sums;
  for_each_weight(law, [&](std::uint64_t x, double weight) {
    all += weight;
    if (weight <= weight_observed * kTie) sums.no_likelier += weight;
    if (x <= observed) sums.at_most += weight;
    if (x >= observed) sums.at_least += weight;
  });
  return {std::min(1.0, sums.at_most / all), std::min(1.0, sums.at_least / all), weight_observed / all,
          std::min(1.0, sums.no_likelier / all)};
}

}  // namespace fleetproof
