#include "reports/evidence/gate_bounds.hpp"

#include <algorithm>
#include <cmath>

#include "reports/evidence/gate_table.hpp"
#include "reports/evidence/refutation.hpp"
#include "reports/evidence/release_gate.hpp"

namespace fleetproof {
namespace {

double largest_limit_not_passed(std::uint64_t failing, std::uint64_t units, Confidence confidence) {
  if (units == 0 || failing == units) return 1.0;
  const double goal = -std::log(confidence.risk());
  const auto passes = [&](double limit) { return log_e_values(failing, units, limit).gate >= goal; };
  double low = 0.0, high = 1.0;  // the gate passes as the limit approaches 1: e grows without bound
  for (double middle = 0.5; middle > low && middle < high; middle = low + (high - low) / 2.0)
    (passes(middle) ? high : low) = middle;
  return high;
}

RateInterval bounds_of_share(GateMethod method, std::uint64_t failing, std::uint64_t units, Confidence confidence) {
  if (method == GateMethod::Fixed)
    return {lower_bound(failing, units, confidence), upper_bound(failing, units, confidence)};
  return {refuted_limit(failing, units, confidence), largest_limit_not_passed(failing, units, confidence)};
}

RateInterval bounds_of_worst(const GateRecord& gate, std::uint64_t failing, std::uint64_t units, const GateCells& cells,
                             Confidence confidence) {
  RateInterval bounds = bounds_of_share(gate.method, failing, units, confidence);
  if (gate.unit == GateUnit::AgvHour) return hourly_rate(bounds, cells);
  if (gate.unit == GateUnit::Run && cells.count > 1) {
    const Confidence shared = confidence.shared(static_cast<double>(cells.count));
    bounds.lower = bounds_of_share(gate.method, failing, units, shared).lower;
  }
  return bounds;
}

}  // namespace

RateInterval gate_bounds(const GateRecord& gate, std::uint64_t failing, std::uint64_t units, const GateCells& cells) {
  return bounds_of_worst(gate, failing, units, cells, gate.confidence);
}

RateInterval gate_interval_95(const GateRecord& gate, std::uint64_t failing, std::uint64_t units,
                              const GateCells& cells) {
  return bounds_of_worst(gate, failing, units, cells, Confidence(0.95).shared(2.0));
}

std::optional<std::uint64_t> units_to_pass(const GateRecord& gate, std::uint64_t failing, std::uint64_t units,
                                           const GateCells& cells) {
  if (gate.method == GateMethod::AnyTime) return passes_from(gate.table, failing);
  const double share = share_to_pass(gate, cells);
  if (share <= 0.0) return std::nullopt;
  auto needed = units_needed(failing, share, gate.confidence);
  if (needed) needed = std::max(*needed, units + 1);  // the two bounds agree but for rounding
  return needed;
}

std::optional<std::uint64_t> units_to_pass_at_this_rate(const GateRecord& gate, std::uint64_t failing,
                                                        std::uint64_t units) {
  const auto& passes_from = gate.table.passes_from;
  for (std::uint64_t k = failing; k < passes_from.size(); ++k) {
    const double expected =
        static_cast<double>(failing) * (static_cast<double>(passes_from[k]) / static_cast<double>(units));
    if (expected <= static_cast<double>(k)) return std::max(passes_from[k], units);
  }
  return std::nullopt;
}

}  // namespace fleetproof
