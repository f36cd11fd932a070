#pragma once

#include <string>

namespace fleetproof {

// A rate or a bound with three significant digits. A bound is rounded away from the claim: an upper bound is never
// rounded down, a lower bound is never rounded up.
std::string rounded_rate(double value);
std::string rounded_up(double value);
std::string rounded_down(double value);

}  // namespace fleetproof
