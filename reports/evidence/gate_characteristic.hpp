#pragma once

#include <cstdint>

#include "reports/evidence/release_gate.hpp"

namespace fleetproof {

// What a campaign that stops at the release gate, or after `most_units` trials, may expect.
struct GateCharacteristic {
  double pass_probability = 0.0;
  double mean_units = 0.0;  // trials until it passes or ends
};

// Exact, by the law of the failures at n(0), n(1), ...: a campaign passes at n(k) if it has exactly k failures there
// and did not pass before. Requires: 0 <= p < 1, the probability with which each trial fails.
GateCharacteristic gate_characteristic(ReleaseGate gate, double p, std::uint64_t most_units);

}  // namespace fleetproof
