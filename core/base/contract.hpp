#pragma once

#include "core/base/sim_time.hpp"

namespace fleetproof {

// The contract of the radio (Sect. 2.4 of the paper): up to this loss and this delay, the fleet must be safe *and* work
// normally. Beyond it, a fleet may stand still; a violation is still a violation. Laws, campaigns, archives and reports
// all take the bounds from here.
inline constexpr double kContractLoss = 0.40;    // share of the receptions lost, at most
inline constexpr double kContractDelay_s = 2.0;  // from sending to reception, at most
inline constexpr Duration kContractDelay = std::chrono::seconds(2);
static_assert(to_seconds(kContractDelay) == kContractDelay_s);

constexpr bool in_contract(double loss, double delay_s) { return loss <= kContractLoss && delay_s <= kContractDelay_s; }
constexpr bool is_worst_case_of_contract(double loss, double delay_s) {
  return loss == kContractLoss && delay_s == kContractDelay_s;
}

}  // namespace fleetproof
