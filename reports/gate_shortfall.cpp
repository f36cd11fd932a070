#include "reports/gate_shortfall.hpp"

#include "core/base/error.hpp"
#include "reports/evidence/gate_table.hpp"

namespace fleetproof {
namespace {

bool meets_limit(const GateRecord& gate, const Estimate& estimate) {
  if (gate.method == GateMethod::AnyTime) return passes(gate.table, estimate.failing, estimate.units);
  return estimate.upper <= gate.limit;
}

}  // namespace

std::string shortfall_of(const GateRecord& gate, const GateResult& result) {
  ensure(result.verdict != Verdict::Demonstrated, "a gate that is demonstrated falls short of nothing");
  const GateCounts& counts = result.counts;
  if (result.verdict == Verdict::Violated) return "violated";
  if (counts.counts_only) return "counts only";
  if (!counts.complete()) return "not complete";
  if (!meets_limit(gate, *result.claim)) {
    if (meets_limit(gate, *result.optimistic)) return "unknown outcomes";
    if (result.units_needed) return "too few " + std::string(result.unit == "replicates" ? "worlds" : result.unit);
    return counts.failing == 0 && counts.failing_or_unknown > 0 ? "unknown outcomes" : "too many failures";
  }
  return counts.met_nobody ? "not tested" : "too little progress";
}

}  // namespace fleetproof
