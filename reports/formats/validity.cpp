#include "reports/formats/validity.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/base/error.hpp"
#include "core/base/random.hpp"
#include "core/base/tolerances.hpp"
#include "reports/evidence/binomial.hpp"
#include "reports/evidence/poisson_rate.hpp"
#include "reports/page/wording.hpp"

namespace fleetproof {
namespace {

std::string line(bool passed, const std::string& what) {
  return fmt::format("{}  {}\n", passed ? "ok  " : "FAIL", what);
}

// Published answers of Philox4x32-10 (Random123, kat_vectors).
bool generator_gives_known_answers() {
  return philox(0, {0, 0, 0, 0}) == Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8} &&
         philox(~0ULL, {~0U, ~0U, ~0U, ~0U}) == Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd} &&
         philox(0x299f31d0a4093822ULL, {0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}) ==
             Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1};
}

bool agrees(double computed, double known) { return std::abs(computed - known) <= 1e-10 * std::abs(known); }

// The limits of 0 of n are 1 - risk^(1/n) and -ln(risk) / T; that of 1 of 10 is from tables of sums of 60 digits.
bool estimators_give_known_answers() {
  return agrees(upper_bound(0, 10, 0.95), 1.0 - std::pow(0.05, 0.1)) &&
         agrees(upper_bound(1, 10, 0.9), 0.336847723306725) && agrees(upper_rate(0, 1.0, 0.95), -std::log(0.05)) &&
         agrees(upper_rate(1, 1.0, 0.9), 3.88972016986743);
}

}  // namespace

std::vector<ValidityCheck> validity_checks(const ReportInput& input) {
  const Evidence& evidence = input.evidence;
  std::vector<ValidityCheck> checks = {
      {generator_gives_known_answers(), true, "the random generator gives the published answers (Philox4x32-10)"},
      {estimators_give_known_answers(), true, "the exact bounds agree with published values to 1e-10"},
      {true, false, "every row of the results file has the checksum that it was stored with"},
      {evidence.engine_errors() == 0, false,
       fmt::format("{} ended in an error of the simulator", count_text(evidence.engine_errors(), "run"))},
      {true, false,
       fmt::format(
           "{} of {} runs have a trace that an earlier run of the same cell had, and count for nothing: a claim "
           "counts no world that passed and whose runs all repeat others (traces of a fleet that never moves "
           "may be equal)",
           evidence.repeated_runs(), evidence.runs())},
      {!has_several_programs(input.campaign.engine), false, "all runs are those of one program"}};
  for (const AgentAudit& audit : evidence.audits().agents()) {
    const std::string agent = printable(audit.agent, 40), doubt = audit_doubt(audit);
    checks.push_back(
        {doubt.empty(), false,
         fmt::format("{} of {} audited runs of {} came out differently in another process, {} were judged "
                     "otherwise, and {} due and not done{}",
                     audit.differing, audit.audited, agent, audit.judged_otherwise, count_text(audit.open, "audit"),
                     doubt.empty() ? "" : ": nothing is demonstrated for this agent")});
  }
  return checks;
}

void require_known_answers(const std::vector<ValidityCheck>& checks) {
  for (const ValidityCheck& check : checks) {
    if (check.is_known_answer && !check.passed)
      throw EngineError("this is wrong on this machine: " + check.text +
                        "; its figures are no evidence; use another build or another machine");
  }
}

std::string validity_text(const ReportInput& input, const std::vector<ValidityCheck>& checks) {
  std::string text =
      "Checks of the tool and of the data, done when this file was written. FAIL: the verdict counts it.\n\n";
  for (const ValidityCheck& check : checks) text += line(check.passed, check.text);
  text += fmt::format("\nVerdict: {}", name_of(overall_verdict(input.evidence, input.gates)));
  if (input.exit_code) text += fmt::format("; `fleetproof report` ends with exit code {}", *input.exit_code);
  text += ".\n";
  text += fmt::format(
      "\nIndependence: replicate i of seed {} draws everything from keys of its own (Philox counters); replicates "
      "share "
      "nothing but the plan. Cells of a replicate share the world, so the world is the unit.\n",
      input.campaign.seed);
  text += fmt::format(
      "Detector: smallest clearances are found to {:g} m, on straight lines, turns, arcs and curves. A clearance is "
      "too "
      "small if more than {:g} m is missing, and {:g} m more for each body that drives a curve.\n",
      kSmallestClearance_m, kBuiltToTheLimit_m, kBuiltOnCurves_m);
  return text;
}

}  // namespace fleetproof
