#include "reports/sections/gate_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/contract.hpp"
#include "core/base/error.hpp"
#include "reports/evidence/exposure.hpp"
#include "reports/evidence/gate_words.hpp"
#include "reports/evidence/rounding.hpp"
#include "reports/page/wording.hpp"
#include "reports/sections/coverage_section.hpp"
#include "reports/sections/plan_conditions.hpp"
#include "reports/sections/sample_sentence.hpp"

namespace fleetproof {
namespace {

std::string failure_text(const GateRecord& gate, std::optional<double> safety_distance_m) {
  switch (gate.end_point) {
    case EndPoint::Violation:
      return "broke the safety distance" +
             (safety_distance_m ? " of " + distance_text(*safety_distance_m) : std::string());
    case EndPoint::Contact:
      return "had a contact";
    case EndPoint::HazardousContact:
      return "had a contact at hazardous speed";
    case EndPoint::Deadlock:
      return "deadlocked";
    case EndPoint::Livelock:
      return "moved without a result (livelock)";
    case EndPoint::Starvation:
      return "left an AGV or an order without progress (starvation)";
    case EndPoint::Standstill:
      return "stood still while the radio kept its contract";
    case EndPoint::WrongLoad:
      return "handled a load wrongly";
    case EndPoint::EmptyBattery:
      return "let a battery run empty";
    case EndPoint::Crash:
      return "crashed";
    case EndPoint::Hang:
      return "hung";
    case EndPoint::Throughput:
      return fmt::format("finished fewer than {:g} transports (orders) per AGV-hour", gate.min_transports_per_agv_hour);
  }
  invariant_violated("an end point has words");
}

std::string region_text(Region region) {
  switch (region) {
    case Region::Contract:
      return fmt::format("loss <= {}, delay <= {:g} s", percent(kContractLoss), kContractDelay_s);
    case Region::WorstCase:
      return fmt::format("loss {}, delay {:g} s", percent(kContractLoss), kContractDelay_s);
    case Region::All:
      return "all cells";
  }
  invariant_violated("a region has words");
}

// What was sampled in the region, and the cells that the gate names in it. If it names a loss or delay, "all cells"
// would mislead.
std::string where_text(const Evidence& evidence, std::size_t index) {
  const GateRecord& gate = evidence.gates()[index];
  const auto& cells = evidence.cells_of(index);
  const std::string named = filter_text(gate.where);
  const auto& factors = gate.where.factors;
  if (gate.region == Region::All && (factors[Factor::Loss] || factors[Factor::Delay])) return named;
  const bool says_sample = gate.region == Region::Contract && !cells.empty();
  return (says_sample ? sampled_quality(evidence, cells) : region_text(gate.region)) +
         (named.empty() ? "" : ", " + named);
}

// " (2400 AGV-hours)", as planned; and ", 12 distinct", if worlds repeat others.
std::string distinct_text(const GateRecord& gate, const GateResult& result) {
  std::string text;
  if (gate.unit == GateUnit::AgvHour) text += fmt::format(" ({:.6g} AGV-hours)", result.optimistic->exposure);
  if (result.counts.distinct < result.counts.units) text += fmt::format(", {} distinct", result.counts.distinct);
  return text;
}

std::string counted_text(const GateRecord& gate, const GateResult& result) {
  const auto &claim = *result.claim, &known = *result.optimistic;
  const std::string text =
      fmt::format("in {} of {} {}{}", known.failing, known.units, result.unit, distinct_text(gate, result));
  const auto unknown = claim.failing - known.failing;
  return unknown == 0 ? text : text + fmt::format(", and {} more ended unknown and count as failing", unknown);
}

std::string failed_of_units(const GateResult& result) {
  return failed_text(result.optimistic->failing, result.claim->failing) + fmt::format("/{}", result.claim->units);
}

std::vector<std::string> row(const ReportInput& input, std::size_t index) {
  const GateRecord& gate = input.evidence.gates()[index];
  const GateResult& result = input.gates[index];
  std::string what = name_of(gate.end_point);
  if (gate.end_point == EndPoint::Throughput) what += fmt::format(" >= {:g}/AGV-h", gate.min_transports_per_agv_hour);
  if (!gate.requirement.empty()) what += " [" + printable(gate.requirement, 30) + "]";
  std::vector<std::string> cells{printable(gate.agent, 40), what, where_text(input.evidence, index)};
  if (result.claim) {
    cells.push_back(failed_of_units(result));
    cells.push_back(value_text(gate, result.claim->upper, rounded_up));
    cells.push_back(gate.kind == GateKind::None ? limit_text(gate) + ", none allowed" : limit_text(gate));
  } else {
    cells.push_back(count_text(result.counts.failing_runs, "run"));
  }
  cells.push_back(std::string(name_of(result.verdict)) + (gate.decides ? "" : " (reported only)"));
  return cells;
}

std::string estimate_text(const GateRecord& gate, const GateResult& result) {
  const auto& claim = *result.claim;
  std::string text = fmt::format("{} of {} {}{} failed", result.optimistic->failing, result.optimistic->units,
                                 result.unit, distinct_text(gate, result));
  const auto unknown = claim.failing - result.optimistic->failing;
  if (unknown > 0) text += fmt::format(" and {} stayed unknown, which counts as failing", unknown);
  const auto up = [&](double bound) { return value_text(gate, bound, rounded_up); };
  if (claim.rate()) {
    text += ": ";
    if (claim.failing > 0) text += value_text(gate, *claim.rate(), rounded_rate) + ", ";
    text += "two-sided 95 % interval " + interval_text(gate, claim.interval_95.lower, claim.interval_95.upper);
  }
  return text +
         fmt::format(", one-sided {} upper bound {}, limit {} ({}).", percent(gate.confidence), up(claim.upper),
                     limit_text(gate),
                     gate.method == GateMethod::AnyTime ? "valid however often one looks" : "for the planned worlds");
}

std::string optimistic_text(const GateRecord& gate, const GateResult& result) {
  return fmt::format(" If none of the unknown had failed: {} of {}, upper bound {}.", result.optimistic->failing,
                     result.optimistic->units, value_text(gate, result.optimistic->upper, rounded_up));
}

bool has_unknown(const GateResult& result) {
  return result.claim && result.claim->failing != result.optimistic->failing;
}

Remark remark_of(const ReportInput& input, std::size_t index) {
  const GateRecord& gate = input.evidence.gates()[index];
  const GateResult& result = input.gates[index];
  std::string text = fmt::format("\"{}\": ", printable(gate.name, 60));
  text += result.claim ? estimate_text(gate, result) : count_text(result.counts.failing_runs, "run") + " failed.";
  if (result.claim && result.optimistic->failing != result.claim->failing) text += optimistic_text(gate, result);
  text += fmt::format(" Why {}: {}.", name_of(result.verdict), result.reason);
  if (cannot_be_violated(gate, input.evidence.gate_cells(index)))
    text += " It cannot be violated: its limit lets a failure into every world.";
  if (input.evidence.is_judged_anew(index))
    text +=
        " The version that wrote this file counted the time until the first failure of each world; judged here is "
        "the share of worlds that failed, which needs no assumption about when failures come.";
  if (!result.missing.empty()) text += " Weak: " + missing_text(result.missing) + ".";
  if (!result.worst) return {text, ""};
  text += " " + worst_run_text(result);
  return {text, replay_line(input, result.worst->run_index)};
}

}  // namespace

std::string worst_run_text(const GateResult& result) {
  const bool known = !result.optimistic || result.optimistic->failing > 0;
  const FailingRun& worst = *result.worst;
  const bool has_reason = worst.end == OutcomeClass::Crash || worst.end == OutcomeClass::Hang;
  return fmt::format(
      "{} is {} ({}{}):", known ? "Its most serious run" : "The most serious of the unknown runs", worst.run_index,
      worst.severity(),
      has_reason && !worst.message.empty() ? fmt::format(": \"{}\"", printable(worst.message, 120)) : "");
}

std::string finding_text(const ReportInput& input, std::size_t index) {
  const GateRecord& gate = input.evidence.gates()[index];
  const GateResult& result = input.gates[index];
  std::string text = failure_text(gate, safety_distance_m(input.campaign.plan_json)) + " ";
  if (const std::string named = filter_text(gate.where); !named.empty()) text += fmt::format("({}) ", named);
  if (!result.claim) return text + "in " + count_text(result.counts.failing_runs, "run");
  text += counted_text(gate, result);
  const bool violated = result.verdict == Verdict::Violated;
  if ((violated ? result.optimistic : result.claim)->units == 0) return text;
  const double bound = violated ? result.optimistic->lower : result.claim->upper;
  if (violated && bound <= 0.0) return text;  // one failing run refutes a gate that allows none; it shows no rate
  if (std::isinf(bound))
    return text + fmt::format("; every world may fail, so that the true rate has no upper bound ({})",
                              percent(gate.confidence));
  return text + fmt::format("; the true {} is at {} {} ({}{})", gate.unit == GateUnit::AgvHour ? "rate" : "share",
                            violated ? "least" : "most", value_text(gate, bound, violated ? rounded_down : rounded_up),
                            percent(gate.confidence),
                            gate.method == GateMethod::AnyTime ? ", however often one looks" : "");
}

Section gate_section(const ReportInput& input) {
  Section section{"Gates (acceptance criteria)", {}, {}};
  if (input.gates.empty()) {
    section.remarks.push_back({"The campaign has no gate.", ""});
    return section;
  }
  section.table.columns = {{"agent", false}, {"end point", false}, {"where", false}, {"failed"}};
  if (!input.evidence.counts_only()) {
    section.table.columns.push_back({"upper bound"});
    section.table.columns.push_back({"limit"});
  }
  section.table.columns.push_back({"verdict", false});
  for (std::size_t i = 0; i < input.gates.size(); ++i) section.table.rows.push_back(row(input, i));
  std::set<std::string> samples;
  for (std::size_t i = 0; i < input.gates.size(); ++i) {
    section.remarks.push_back(remark_of(input, i));
    const auto& cells = input.evidence.cells_of(i);
    if (!cells.empty()) samples.insert("Sampled: " + sampled(input.evidence, cells) + ".");
  }
  if (std::ranges::any_of(input.gates, has_unknown)) section.remarks.emplace_back().text = std::string(kUnknownMeans);
  for (const std::string& sample : samples) section.remarks.push_back({sample, ""});
  return section;
}

}  // namespace fleetproof
