#include "reports/evidence/refutation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.hpp"

namespace fleetproof {
namespace {

constexpr std::array kOddsRatios{2.0, 5.0, 20.0};

}  // namespace

double log_refutation(std::uint64_t failing, std::uint64_t units, double limit) {
  ensure(failing <= units, "no more trials fail than there are");
  std::array<double, kOddsRatios.size()> logs{};
  for (std::size_t i = 0; i < logs.size(); ++i) {
    logs[i] = static_cast<double>(failing) * std::log(kOddsRatios[i]) -
              static_cast<double>(units) * std::log1p((kOddsRatios[i] - 1.0) * limit);
  }
  const double largest = *std::ranges::max_element(logs);
  double sum = 0.0;
  for (const double log : logs) sum += std::exp(log - largest);
  return largest + std::log(sum / static_cast<double>(logs.size()));
}

double refuted_limit(std::uint64_t failing, std::uint64_t units, Confidence confidence) {
  const double goal = -std::log(confidence.risk());
  const auto refuted = [&](double limit) { return log_refutation(failing, units, limit) >= goal; };
  if (!refuted(0.0)) return 0.0;
  double low = 0.0, high = 1.0;
  for (double middle = 0.5; middle > low && middle < high; middle = low + (high - low) / 2.0)
    (refuted(middle) ? low : high) = middle;
  return low;
}

}  // namespace fleetproof
