#pragma once

#include <string>

namespace fleetproof {

// A rate or a bound in three significant digits. A bound is rounded away from the claim: an upper one never down, a
// lower one never up.
std::string rounded_rate(double value);
std::string rounded_up(double value);
std::string rounded_down(double value);

}  // namespace fleetproof
