#include "reports/sections/gate_shortfall.hpp"

#include "core/base/error.hpp"

namespace fleetproof {

std::string shortfall_of(const GateRecord& gate, const GateResult& result) {
  ensure(result.verdict != Verdict::Demonstrated, "a gate that is demonstrated falls short of nothing");
  const GateCounts& counts = result.counts;
  if (result.verdict == Verdict::Violated) return "violated";
  if (counts.counts_only) return "counts only";
  const bool waits_for_the_plan = gate.method == GateMethod::Fixed && !counts.complete();
  if (waits_for_the_plan || result.optimistic->units == 0) return "not complete";
  if (!meets_limit(gate, *result.claim)) {
    if (meets_limit(gate, *result.optimistic)) return "unknown outcomes";
    if (result.units_needed) return "too few " + std::string(result.unit);
    return counts.failing == 0 && counts.failing_or_unknown > 0 ? "unknown outcomes" : "too many failures";
  }
  return counts.met_nobody ? "not tested" : "too little progress";
}

}  // namespace fleetproof
