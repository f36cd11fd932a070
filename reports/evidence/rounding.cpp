#include "reports/evidence/rounding.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

namespace fleetproof {
namespace {

// Adds or subtracts one unit in the third digit if rounding to the nearest went the wrong way.
std::string rounded_towards(double value, double direction) {
  auto text = fmt::format("{:.2e}", value);
  const double nearest = std::strtod(text.c_str(), nullptr);
  if ((value - nearest) * direction > 0.0) {
    const auto exponent = std::atoi(text.substr(text.find('e') + 1).c_str());
    text = fmt::format("{:.2e}", nearest + direction * std::pow(10.0, exponent - 2));
  }
  return fmt::format("{:.3g}", std::strtod(text.c_str(), nullptr));
}

}  // namespace

std::string rounded_rate(double value) { return fmt::format("{:.3g}", value); }
std::string rounded_up(double value) { return rounded_towards(value, 1.0); }
std::string rounded_down(double value) { return rounded_towards(value, -1.0); }

}  // namespace fleetproof
