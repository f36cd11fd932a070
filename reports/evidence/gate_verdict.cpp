#include "reports/evidence/gate_verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "reports/evidence/exposure.hpp"
#include "reports/evidence/gate_bounds.hpp"
#include "reports/evidence/gate_table.hpp"
#include "reports/evidence/gate_words.hpp"
#include "reports/evidence/poisson_rate.hpp"
#include "reports/evidence/rounding.hpp"

namespace fleetproof {
namespace {

void add_sentence_part(std::string& sentence, const std::string& part) {
  sentence += (sentence.empty() ? "" : "; ") + part;
}

std::string more_text(const GateRecord& gate, std::uint64_t units) {
  return gate.unit == GateUnit::AgvHour ? fmt::format(" ({:.6g} more)", agv_hours(units))
                                        : fmt::format(" ({} more)", units);
}

// Why the counts do not meet the limit, and what would help. How many more would do is said only of any-time gates: of
// a fixed one the number would have to be fixed beforehand.
std::string bound_too_high(const GateRecord& gate, GateResult& result) {
  const auto& claim = *result.claim;
  if (claim.units == 0) return "no AGV-hour counts: the first run of each replicate ended unknown";
  std::string text = fmt::format("the upper bound {} is above the limit {}", value_text(gate, claim.upper, rounded_up),
                                 limit_text(gate));
  const auto unknown = result.counts.failing_or_unknown - result.counts.failing;
  if (unknown > 0)
    text += fmt::format(" ({} of {} ended unknown and count as failing)", unknown,
                        amount_text(gate, claim.units, result.unit));
  const auto needed = units_to_pass(gate, claim.failing, claim.units);
  if (!needed && gate.limit <= 0.0) return text + "; no number of runs can meet it";
  if (!needed)
    return text + (result.counts.failing == 0 ? "; none failed, but too many are unknown for this limit"
                                              : "; too many failed for this limit");
  if (claim.failing > 0 && claim.rate() >= gate.limit) {
    return text + fmt::format("; so is what was seen, {}: more runs will not help",
                              value_text(gate, *claim.rate(), rounded_rate));
  }
  result.units_needed = needed;
  const auto clean = claim.failing == 0 ? " without a failure"
                                        : fmt::format(" in all, with no failure beyond the {} counted,", claim.failing);
  text += fmt::format("; {}{} are needed", amount_text(gate, *needed, result.unit), clean);
  if (gate.method == GateMethod::Fixed) return text + ", a number to be planned before the first run";
  text += more_text(gate, *needed - claim.units);
  if (claim.failing == 0) return text;
  const auto at_this_rate = units_to_pass_at_this_rate(gate, claim.failing, claim.units);
  if (at_this_rate)
    return text + fmt::format("; if failures go on as they were seen, about {}",
                              amount_text(gate, *at_this_rate, result.unit));
  result.units_needed = std::nullopt;
  return text + "; if failures go on as they were seen, more runs will not help";
}

bool asks_for_progress(const GateRecord& gate) { return !(gate.min_transports_per_agv_hour <= 0.0); }

// Everything that is missing for "demonstrated"; empty if nothing is missing.
std::string missing_for_demonstration(const GateRecord& gate, GateResult& result) {
  const auto& counts = result.counts;
  std::string missing;
  if (!counts.complete() && gate.method == GateMethod::Fixed) {
    add_sentence_part(
        missing,
        fmt::format("stopped after {} of {} planned replicates; the bound holds only for the number fixed beforehand",
                    counts.replicates, counts.planned));
  }
  if (!meets_limit(gate, *result.claim)) add_sentence_part(missing, bound_too_high(gate, result));
  if (counts.met_nobody)
    add_sentence_part(missing, "no run met an encounter of two AGVs: what this gate claims was never put to the test");
  if (!asks_for_progress(gate)) return missing;
  const double rate = counts.transports_per_agv_hour.value_or(0.0);
  if (!(rate >= gate.min_transports_per_agv_hour)) {
    add_sentence_part(missing, fmt::format("the fleet made too little progress: {:.2f} transports per AGV-hour, the "
                                           "floor is {:g} (a parked fleet is safe and useless)",
                                           rate, gate.min_transports_per_agv_hour));
  }
  if (counts.idle_cells > 0)
    add_sentence_part(missing,
                      fmt::format("in {} of {} cells{} no transport was completed", counts.idle_cells, counts.due_cells,
                                  counts.due_cells < counts.cells ? " of the contract region" : ""));
  return missing;
}

std::optional<std::string> refutation(const GateRecord& gate, const GateResult& result) {
  const auto& counts = result.counts;
  if (gate.kind == GateKind::None) {
    if (counts.failing_runs == 0) return std::nullopt;
    return fmt::format("{} {} failed and this gate allows none", counts.failing_runs,
                       counts.failing_runs == 1 ? "run" : "runs");
  }
  if (counts.counts_only || result.optimistic->units == 0) return std::nullopt;
  const bool refuted = gate.method == GateMethod::AnyTime
                           ? refutes(gate.table, result.optimistic->failing, result.optimistic->units)
                           : counts.complete() && result.optimistic->lower > gate.limit;
  if (!refuted) return std::nullopt;
  return fmt::format("the lower bound {} exceeds the limit {}",
                     value_text(gate, result.optimistic->lower, rounded_down), limit_text(gate));
}

std::string_view unit_of(const GateRecord& gate, const GateCounts& counts) {
  if (gate.unit == GateUnit::AgvHour) return "AGV-hours";
  return gate.unit == GateUnit::Run || counts.cells == 1 ? "runs" : "worlds";
}

}  // namespace

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::Demonstrated:
      return "demonstrated";
    case Verdict::Violated:
      return "violated";
    case Verdict::NotDemonstrated:
      return "not demonstrated";
  }
  invariant_violated("a verdict has a name");
}

std::optional<double> Estimate::rate() const {
  if (units == 0) return std::nullopt;
  return static_cast<double>(failing) / exposure;
}

Estimate estimate(const GateRecord& gate, std::uint64_t failing, std::uint64_t units, std::size_t cells) {
  const RateInterval bounds = gate_bounds(gate, failing, units, cells);
  const double exposure = gate.unit == GateUnit::AgvHour ? agv_hours(units) : static_cast<double>(units);
  return {units, failing, exposure, bounds.lower, bounds.upper, gate_interval_95(gate, failing, units, cells)};
}

bool meets_limit(const GateRecord& gate, const Estimate& estimate) {
  if (gate.method == GateMethod::AnyTime) return passes(gate.table, estimate.failing, estimate.units);
  return estimate.upper <= gate.limit;
}

GateResult judge_gate(const GateRecord& gate, const GateCounts& counts) {
  ensure(counts.failing <= counts.failing_or_unknown, "failing units are failing or unknown");
  ensure(counts.failing_or_unknown <= counts.units || gate.unit == GateUnit::AgvHour, "failing units are units");
  GateResult result;
  result.counts = counts;
  result.unit = unit_of(gate, counts);
  if (!counts.counts_only) {
    const std::uint64_t most_units = gate.unit == GateUnit::AgvHour ? counts.most_units : counts.units;
    result.claim = estimate(gate, counts.failing_or_unknown, counts.units, counts.cells);
    result.optimistic = estimate(gate, counts.failing, most_units, counts.cells);
  }
  if (const auto reason = refutation(gate, result)) {
    result.verdict = Verdict::Violated;
    result.reason = *reason;
    return result;
  }
  if (counts.cells == 0) {
    result.reason =
        fmt::format("no cell of the campaign lies in the region of this gate for agent {}", printable(gate.agent, 40));
  } else if (counts.counts_only) {
    result.reason = "a search campaign gives counts, not rates; use kind \"claim\" to demonstrate";
  } else if (result.optimistic->units == 0) {
    result.units_needed = units_to_pass(gate, 0, 0);
    result.reason = "no replicate is complete";
    if (result.units_needed)
      result.reason +=
          fmt::format("; {} without a failure are needed", amount_text(gate, *result.units_needed, result.unit));
  } else {
    result.reason = missing_for_demonstration(gate, result);
  }
  if (!result.reason.empty()) return result;
  result.verdict = Verdict::Demonstrated;
  result.reason = fmt::format("the upper bound {} is at or below the limit {}",
                              value_text(gate, result.claim->upper, rounded_up), limit_text(gate));
  result.reason += asks_for_progress(gate)
                       ? fmt::format(", and the fleet made progress ({:.2f} transports per AGV-hour)",
                                     counts.transports_per_agv_hour.value_or(0.0))
                       : ", and no progress was asked for";
  return result;
}

}  // namespace fleetproof
