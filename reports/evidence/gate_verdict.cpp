#include "reports/evidence/gate_verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "reports/evidence/gate_bounds.hpp"
#include "reports/evidence/gate_table.hpp"
#include "reports/evidence/gate_words.hpp"
#include "reports/evidence/rounding.hpp"

namespace fleetproof {
namespace {

void add_sentence_part(std::string& sentence, const std::string& part) {
  sentence += (sentence.empty() ? "" : "; ") + part;
}

// Why the counts do not meet the limit, and what would help. How many more would do is said only of any-time gates: of
// a fixed one the number would have to be fixed beforehand.
std::string bound_too_high(const GateRecord& gate, GateResult& result) {
  const auto& claim = *result.claim;
  std::string text =
      std::isinf(claim.upper)
          ? "every world may fail, so that the rate has no upper bound, and the limit is " + limit_text(gate)
          : fmt::format("the upper bound {} is above the limit {}", value_text(gate, claim.upper, rounded_up),
                        limit_text(gate));
  const auto unknown = result.counts.failing_or_unknown - result.counts.failing;
  if (unknown > 0)
    text +=
        fmt::format(" ({} of {} ended unknown and count as failing)", unknown, amount_text(claim.units, result.unit));
  if (result.counts.distinct < result.counts.units)
    text += fmt::format(" (of {}, {} distinct: a world whose runs all repeat others is no evidence of its own)",
                        amount_text(result.counts.units, result.unit),
                        result.counts.distinct == 1 ? "1 is" : fmt::format("{} are", result.counts.distinct));
  const auto needed = units_to_pass(gate, claim.failing, claim.units, result.counts.cells);
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
  text += fmt::format("; {}{} are needed", amount_text(*needed, result.unit), clean);
  if (gate.method == GateMethod::Fixed) return text + ", a number to be planned before the first run";
  text += fmt::format(" ({} more)", *needed - claim.units);
  if (claim.failing == 0) return text;
  const auto at_this_rate = units_to_pass_at_this_rate(gate, claim.failing, claim.units);
  if (at_this_rate)
    return text +
           fmt::format("; if failures go on as they were seen, about {}", amount_text(*at_this_rate, result.unit));
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
  if (!counts.doubt.empty()) add_sentence_part(missing, counts.doubt);
  if (counts.met_nobody)
    add_sentence_part(missing,
                      "in no run two AGVs met while both drove: what this gate claims was never put to the test");
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
                                  counts.due_cells < counts.cells.count ? " of the contract region" : ""));
  return missing;
}

// Whether the known failures alone refute the limit, if the number of units is one that may decide.
bool exceeds_limit(const GateRecord& gate, const UnitCount& count, const GateCells& cells) {
  if (gate.method == GateMethod::AnyTime) return refutes(gate.table, count.failing, count.units);
  return gate_bounds(gate, count.failing, count.units, cells).lower > gate.limit;
}

std::optional<std::string> refutation(const GateRecord& gate, const GateResult& result) {
  const auto& counts = result.counts;
  if (gate.kind == GateKind::None) {
    if (counts.failing_runs == 0 && counts.failing_audits > 0)
      return fmt::format("{} {} failed when simulated once more, and this gate allows none", counts.failing_audits,
                         counts.failing_audits == 1 ? "run" : "runs");
    if (counts.failing_runs == 0) return std::nullopt;
    return fmt::format("{} {} failed and this gate allows none", counts.failing_runs,
                       counts.failing_runs == 1 ? "run" : "runs");
  }
  if (counts.counts_only || result.optimistic->units == 0) return std::nullopt;
  const bool may_decide = gate.method == GateMethod::AnyTime || counts.complete();
  if (!may_decide || !exceeds_limit(gate, counts, counts.cells)) return std::nullopt;
  return fmt::format("the lower bound {} exceeds the limit {}",
                     value_text(gate, result.optimistic->lower, rounded_down), limit_text(gate));
}

std::string_view unit_of(const GateRecord& gate, const GateCounts& counts) {
  return gate.unit == GateUnit::Run || counts.cells.count == 1 ? "runs" : "worlds";
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
  if (exposure <= 0.0) return std::nullopt;
  return static_cast<double>(failing) / exposure;
}

Estimate estimate(const GateRecord& gate, std::uint64_t failing, std::uint64_t units, const GateCells& cells) {
  const RateInterval bounds = gate_bounds(gate, failing, units, cells);
  const double each = gate.unit == GateUnit::AgvHour ? cells.run_agv_hours * static_cast<double>(cells.count) : 1.0;
  const double exposure = each * static_cast<double>(units);
  return {units, failing, exposure, bounds.lower, bounds.upper, gate_interval_95(gate, failing, units, cells)};
}

bool meets_limit(const GateRecord& gate, const Estimate& estimate) {
  if (gate.method == GateMethod::AnyTime) return passes(gate.table, estimate.failing, estimate.units);
  return estimate.upper <= gate.limit;
}

UnitCount deciding_count(const GateRecord& gate, const std::vector<UnitCount>& by_cell, const GateCells& cells) {
  const UnitCount& most_failing = *std::ranges::max_element(by_cell, {}, &UnitCount::failing);
  if (by_cell.size() == 1 || exceeds_limit(gate, most_failing, cells)) return most_failing;
  // The more failed and the fewer count, the higher is the bound: most cells are no worse than another one.
  std::vector<const UnitCount*> order;
  for (const UnitCount& count : by_cell) order.push_back(&count);
  std::ranges::stable_sort(order, {}, [](const UnitCount* count) {
    return std::tuple(~count->failing_or_unknown, count->counted, ~count->failing);
  });
  const UnitCount* worst = order.front();
  double highest = gate_bounds(gate, worst->failing_or_unknown, worst->counted, cells).upper;
  std::uint64_t fewest = worst->counted;
  for (const UnitCount* count : order) {
    if (count->counted >= fewest) continue;
    fewest = count->counted;
    const double upper = gate_bounds(gate, count->failing_or_unknown, count->counted, cells).upper;
    if (upper <= highest) continue;
    highest = upper;
    worst = count;
  }
  return *worst;
}

GateResult judge_gate(const GateRecord& gate, const GateCounts& counts) {
  ensure(counts.failing <= counts.failing_or_unknown, "failing units are failing or unknown");
  ensure(counts.failing_or_unknown <= counts.counted, "failing units count");
  ensure(counts.counted <= counts.units, "what counts are units");
  GateResult result;
  result.counts = counts;
  result.unit = unit_of(gate, counts);
  if (!counts.counts_only) {
    result.claim = estimate(gate, counts.failing_or_unknown, counts.counted, counts.cells);
    result.optimistic = estimate(gate, counts.failing, counts.units, counts.cells);
  }
  if (const auto reason = refutation(gate, result)) {
    result.verdict = Verdict::Violated;
    result.reason = *reason;
    return result;
  }
  if (counts.cells.count == 0) {
    result.reason =
        fmt::format("no cell of the campaign lies in the region of this gate for agent {}", printable(gate.agent, 40));
  } else if (counts.counts_only) {
    result.reason = "a search campaign gives counts, not rates; use kind \"claim\" to demonstrate";
  } else if (result.optimistic->units == 0) {
    result.units_needed = units_to_pass(gate, 0, 0, counts.cells);
    result.reason = "no replicate is complete";
    if (result.units_needed)
      result.reason += fmt::format("; {} without a failure are needed", amount_text(*result.units_needed, result.unit));
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
