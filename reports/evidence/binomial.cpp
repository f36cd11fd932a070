#include "reports/evidence/binomial.hpp"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>
#include <functional>

#include "core/base/error.hpp"

namespace fleetproof {
namespace {

constexpr std::uint64_t kMostUnits = 1'000'000'000'000'000;

void require_sense(std::uint64_t failing, std::uint64_t units, double confidence) {
  ensure(failing <= units, "no more trials fail than there are");
  ensure(confidence > 0.0 && confidence < 1.0, "a confidence lies between 0 and 1");
}

// Closed forms at the edges. They are exact where the inverse beta function loses digits, and the edges are the usual
// case.
double upper_at_risk(std::uint64_t failing, std::uint64_t units, double risk) {
  if (failing == units) return 1.0;
  const auto k = static_cast<double>(failing), n = static_cast<double>(units);
  if (failing == 0) return -std::expm1(std::log(risk) / n);
  return boost::math::ibetac_inv(k + 1.0, n - k, risk);
}

double lower_at_risk(std::uint64_t failing, std::uint64_t units, double risk) {
  if (failing == 0) return 0.0;
  const auto k = static_cast<double>(failing), n = static_cast<double>(units);
  if (failing == units) return std::exp(std::log(risk) / n);
  return boost::math::ibeta_inv(k, n - k + 1.0, risk);
}

// Probability of `failing` or fewer failures; it falls as `units` grows.
double probability_of_at_most(std::uint64_t failing, std::uint64_t units, double p) {
  if (failing >= units) return 1.0;
  return boost::math::ibetac(static_cast<double>(failing) + 1.0, static_cast<double>(units - failing), p);
}

}  // namespace

Interval two_sided_interval(std::uint64_t failing, std::uint64_t units, double confidence) {
  require_sense(failing, units, confidence);
  const double risk = (1.0 - confidence) / 2.0;
  return {lower_at_risk(failing, units, risk), upper_at_risk(failing, units, risk)};
}

double lower_bound(std::uint64_t failing, std::uint64_t units, double confidence) {
  require_sense(failing, units, confidence);
  return lower_at_risk(failing, units, 1.0 - confidence);
}

double upper_bound(std::uint64_t failing, std::uint64_t units, double confidence) {
  require_sense(failing, units, confidence);
  return upper_at_risk(failing, units, 1.0 - confidence);
}

std::optional<std::uint64_t> units_needed(std::uint64_t failing, double limit, double confidence) {
  ensure(confidence > 0.0 && confidence < 1.0, "a confidence lies between 0 and 1");
  if (!(limit > 0.0)) return std::nullopt;
  if (limit >= 1.0) return failing;
  const double risk = 1.0 - confidence;
  const auto enough = [&](std::uint64_t units) { return probability_of_at_most(failing, units, limit) <= risk; };
  std::uint64_t too_few = failing, plenty = std::max<std::uint64_t>(failing, 1) * 2;
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

FisherResult fisher_exact(std::uint64_t failing1, std::uint64_t units1, std::uint64_t failing2, std::uint64_t units2) {
  ensure(failing1 <= units1 && failing2 <= units2, "no more trials fail than there are");
  // Given the margins, the failures in the first group are hypergeometric. The probabilities are computed outwards from
  // the mode, by the ratio of neighbours, and then divided by their sum. This needs no factorial and has full precision
  // for large groups.
  const auto n1 = static_cast<double>(units1), n2 = static_cast<double>(units2),
             failures = static_cast<double>(failing1 + failing2);
  const auto least = failing1 + failing2 > units2 ? failing1 + failing2 - units2 : 0;
  const auto most = std::min(failing1 + failing2, units1);
  const auto ratio_up = [&](std::uint64_t x) {  // weight(x + 1) / weight(x)
    const auto k = static_cast<double>(x);
    return (failures - k) * (n1 - k) / ((k + 1.0) * (n2 - failures + k + 1.0));
  };
  const auto mode =
      std::clamp(static_cast<std::uint64_t>((failures + 1.0) * (n1 + 1.0) / (n1 + n2 + 2.0)), least, most);
  const auto for_each_weight = [&](const std::function<void(std::uint64_t, double)>& visit) {
    double weight = 1.0;
    visit(mode, weight);
    for (auto x = mode; x < most && weight > 0.0; ++x) visit(x + 1, weight *= ratio_up(x));
    weight = 1.0;
    for (auto x = mode; x > least && weight > 0.0; --x) visit(x - 1, weight /= ratio_up(x - 1));
  };
  double observed = 0.0;
  for_each_weight([&](std::uint64_t x, double weight) { observed = x == failing1 ? weight : observed; });
  constexpr double kTie = 1.0 + 1e-7;  // two tables of equal probability differ by rounding
  double all = 0.0, no_likelier = 0.0, smaller = 0.0, larger = 0.0;
  for_each_weight([&](std::uint64_t x, double weight) {
    all += weight;
    if (weight <= observed * kTie) no_likelier += weight;
    if (x <= failing1) smaller += weight;
    if (x >= failing1) larger += weight;
  });
  return {std::min(1.0, no_likelier / all), std::min(1.0, smaller / all), std::min(1.0, larger / all)};
}

}  // namespace fleetproof
