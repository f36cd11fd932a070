#include "reports/verdict_sentences.hpp"

#include <fmt/format.h>

#include "core/base/contract.hpp"
#include "reports/coverage_section.hpp"
#include "reports/evidence/rounding.hpp"
#include "reports/sample_sentence.hpp"
#include "reports/wording.hpp"

namespace fleetproof {
namespace {

std::string region_text(Region region) {
  switch (region) {
    case Region::Contract:
      return fmt::format("contract region (loss <= {}, delay <= {:g} s)", percent(kContractLoss), kContractDelay_s);
    case Region::WorstCase:
      return fmt::format("worst case ({}, {:g} s)", percent(kContractLoss), kContractDelay_s);
    case Region::All:
      return "all cells";
  }
  return {};
}

std::string estimate_text(const GateRecord& gate, const GateResult& result) {
  const auto& claim = *result.claim;
  auto text = fmt::format("{} of {} {} failed", claim.failing, claim.units, result.unit);
  if (claim.rate()) {
    text += fmt::format(": rate {}, two-sided 95 % interval [{}, {}]", rounded_rate(*claim.rate()),
                        rounded_down(claim.interval_95.lower), rounded_up(claim.interval_95.upper));
  }
  return text + fmt::format(", one-sided {} upper bound {}, limit {:g} ({}).", percent(gate.confidence),
                            rounded_up(claim.upper), gate.limit,
                            gate.method == GateMethod::AnyTime ? "valid at any time" : "for the planned replicates");
}

std::string optimistic_text(const GateResult& result) {
  return fmt::format(
      "What stayed unknown (a crash, a hang, a wreck before) counts as a failure; if none of it had failed: {} of {}, "
      "upper bound {}.",
      result.optimistic->failing, result.optimistic->units, rounded_up(result.optimistic->upper));
}

Headline verdict_of(const ReportInput& input, std::size_t index) {
  const auto& gate = input.evidence.gates()[index];
  const auto& result = input.gates[index];
  Headline headline{name_of(result.verdict),
                    fmt::format("gate \"{}\": {} of agent {}, {}, {}", printable(gate.name, 60),
                                name_of(gate.end_point), printable(gate.agent, 40), region_text(gate.region),
                                gate.kind == GateKind::None ? "none allowed" : "rate limited") +
                        (result.missing.empty() ? "" : "; the evidence is weak"),
                    {}};
  const auto add = [&](std::string text) { headline.details.push_back({std::move(text), ""}); };
  add(result.claim ? estimate_text(gate, result) : count_text(result.counts.failing_runs, "run") + " failed.");
  if (result.claim && result.optimistic->failing != result.claim->failing) add(optimistic_text(result));
  add(fmt::format("Why {}: {}.", name_of(result.verdict), result.reason));
  if (!result.missing.empty()) add("Weak: " + missing_text(result.missing) + ".");
  if (const auto& cells = input.evidence.cells_of(index); !cells.empty())
    add("Sampled: " + sampled(input.evidence, cells) + ".");
  if (result.worst) {
    headline.details.push_back(
        {fmt::format("Its most serious run is {} ({}):", result.worst->run_index, name_of(result.worst->severity)),
         replay_line(input, result.worst->run_index)});
  }
  return headline;
}

}  // namespace

Remark describe(const ReportInput& input, const FailingRun& run) {
  const auto& cell = input.evidence.cells()[run.cell];
  auto text =
      fmt::format("run {}: {}", run.run_index,
                  run.severity == Severity::Incident ? info_of(run.incident->kind).name : name_of(run.severity));
  if (run.closest && level_of(*run.closest) == ViolationLevel::HazardousContact) {
    text +=
        fmt::format(" at hazardous speed ({:.1f} m/s)", static_cast<double>(run.closest->relative_speed_um_s) * 1e-6);
  }
  if (run.closest) {
    text += fmt::format(", {} at {} between {} and {}", metres_text(run.closest->min_clearance_um),
                        seconds_text(to_seconds(run.closest->closest_at)), body_name(run.closest->a, cell),
                        body_name(run.closest->b, cell));
    if (run.violations > 1) text += fmt::format(" (the closest of {})", run.violations);
  }
  text += fmt::format("; agent {}, layout {}, fleet of {}, {}", printable(cell.agent, 40), printable(cell.layout, 40),
                      cell.fleet_size, factors_text(run.factors));
  if (!run.message.empty()) text += fmt::format("; \"{}\"", printable(run.message, 120));
  const std::string debug = debug_command(input.archive_path, run.run_index);
  if (run.severity == Severity::Crash || run.severity == Severity::Hang) return {text, debug};
  // A worse end point hides no crash.
  if (run.message.starts_with("agent of ")) text += "; in a debugger: " + debug;
  return {text, replay_line(input, run.run_index)};
}

std::vector<Headline> warnings(const ReportInput& input) {
  std::vector<Headline> list;
  if (const auto errors = input.evidence.engine_errors(); errors > 0) {
    list.push_back(
        {"engine error",
         fmt::format(
             "{} ended in an error of the simulator itself: nothing here is evidence until that error is corrected.",
             count_text(errors, "run")),
         {}});
  }
  for (const auto& [agent, runs, worst] : input.evidence.contract_failures()) {
    list.push_back(
        {"violation",
         fmt::format("agent {} broke the safety distance in {} within the contract region. The most serious:",
                     printable(agent, 40), count_text(runs, "run")),
         {describe(input, worst)}});
  }
  return list;
}

std::vector<Headline> verdicts(const ReportInput& input) {
  std::vector<Headline> list;
  for (std::size_t i = 0; i < input.gates.size(); ++i) list.push_back(verdict_of(input, i));
  if (list.empty())
    list.push_back({name_of(Verdict::NotDemonstrated),
                    "this campaign has no gate (acceptance criterion), so nothing can be demonstrated.",
                    {}});
  return list;
}

}  // namespace fleetproof
