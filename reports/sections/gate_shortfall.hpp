#pragma once

#include <string>

#include "reports/evidence/gate_verdict.hpp"

namespace fleetproof {

// What keeps a gate from being demonstrated, in two or three words that programs may compare. The first that holds:
// "violated", "counts only" (of a search), "not complete" (of a fixed gate, planned replicates are missing; of others,
// all), "unknown outcomes" (without them, the counts would do), "too few worlds" (or runs, or AGV-hours: more of them
// without a failure would do), "too many failures", "not tested", "too little progress". Requires: the gate is not
// demonstrated.
std::string shortfall_of(const GateRecord& gate, const GateResult& result);

}  // namespace fleetproof
