#include "reports/formats/junit_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.hpp"
#include "core/base/markup_text.hpp"
#include "core/base/outside_text.hpp"
#include "reports/page/wording.hpp"
#include "reports/sections/gate_section.hpp"

namespace fleetproof {
namespace {

// In one line.
std::string escaped(std::string_view text) { return escaped_for_markup(printable(text)); }

std::string escaped_lines(std::string_view text) { return escaped_for_markup(printable_lines(text)); }

enum class Ending { Passed, Failed, Skipped, Error };

Ending ending_of(const ReportInput& input, std::size_t gate) {
  const GateResult& result = input.gates[gate];
  if (conclusion_of(input) == Conclusion::EngineFault) return Ending::Error;
  const bool tested = result.counts.cells.count > 0 && !result.counts.met_nobody;
  if (!input.evidence.gates()[gate].decides || (!tested && result.verdict != Verdict::Violated)) return Ending::Skipped;
  return result.verdict == Verdict::Demonstrated ? Ending::Passed : Ending::Failed;
}

double agv_hours_of(const Evidence& evidence, const std::vector<std::uint32_t>& cells) {
  Tally sum;
  for (const std::uint32_t cell : cells) sum.add(evidence.tally(cell));
  return sum.agv_hours();
}

double all_agv_hours(const Evidence& evidence) {
  Tally sum;
  for (const CellRecord& cell : evidence.cells()) sum.add(evidence.tally(cell.index));
  return sum.agv_hours();
}

// What readers show beside every case, passed or not.
std::string figures_text(const ReportInput& input, std::size_t index) {
  const GateCounts& counts = input.gates[index].counts;
  return fmt::format("unknown outcomes: {}; simulated: {:.1f} AGV-hours", counts.failing_or_unknown - counts.failing,
                     agv_hours_of(input.evidence, input.evidence.cells_of(index)));
}

// What keeps a gate from being demonstrated, in two or three words that programs may compare. The first that holds:
// "violated", "counts only" (of a search), "not complete" (of a fixed gate, planned replicates are missing; of others,
// all), "unknown outcomes" (without them, the counts would do), "too few worlds" (or runs, or AGV-hours: more of them
// without a failure would do), "too many failures", "audits" (that came out otherwise, or are not done), "not tested",
// "too little progress". Requires: the gate is not demonstrated.
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
  if (!counts.doubt.empty()) return "audits";
  return counts.met_nobody ? "not tested" : "too little progress";
}

// Readers show the content of an element or its message, but not both.
std::string outcome_element(const ReportInput& input, std::size_t index) {
  const GateRecord& gate = input.evidence.gates()[index];
  const GateResult& result = input.gates[index];
  const std::string message = fmt::format("{}: {} {}", name_of(result.verdict), gate.agent, finding_text(input, index));
  std::string text = fmt::format("{}\nWhy: {}.\n{}", message, result.reason, figures_text(input, index));
  if (result.worst) text += "\n" + replay_line(input, result.worst->run_index);
  switch (ending_of(input, index)) {
    case Ending::Passed:
      return "";
    case Ending::Failed:
      return fmt::format("      <failure type=\"{}\" message=\"{}\">{}</failure>\n",
                         escaped(shortfall_of(gate, result)), escaped(message), escaped_lines(text));
    case Ending::Skipped:
      return fmt::format("      <skipped message=\"{}\"/>\n",
                         escaped(gate.decides ? "not put to the test: " + result.reason
                                              : "reported only, a reference agent: " + message));
    case Ending::Error:
      return fmt::format("      <error type=\"engine error\" message=\"{}\"/>\n",
                         escaped("the engine met an error of its own: nothing here is evidence"));
  }
  return "";
}

// Readers take each dot for a step of the hierarchy, and some cut at a blank.
std::string class_step(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return c == '.' || c == ' '; }, '_');
  return text;
}

// "all.ring.fleet_of_5,_loss_40_%,_delay_0,5_s"
std::string place_of(const GateRecord& gate) {
  std::string text = class_step(name_of(gate.region));
  if (!gate.where.layout.empty()) text += "." + class_step(gate.where.layout);
  CellFilter others = gate.where;
  others.layout.clear();
  std::string named = filter_text(others);
  if (named.empty()) return text;
  std::ranges::replace(named, '.', ',');
  return text + "." + class_step(named);
}

std::string name_of_case(const GateRecord& gate) {
  std::string name = gate.name;
  const bool is_named = class_step(gate.agent) == gate.agent || name.find(gate.agent) != std::string::npos;
  if (!is_named) name += " (agent " + gate.agent + ")";
  if (!gate.requirement.empty()) name += " [" + gate.requirement + "]";
  return name;
}

std::string case_element(const ReportInput& input, std::size_t index) {
  const GateRecord& gate = input.evidence.gates()[index];
  return fmt::format(
      "    <testcase name=\"{}\" classname=\"fleetproof.{}.{}\" time=\"0\">\n{}"
      "      <system-out>{}</system-out>\n    </testcase>\n",
      escaped(name_of_case(gate)), escaped(place_of(gate)), escaped(class_step(gate.agent)),
      outcome_element(input, index),
      escaped(gate.agent + " " + finding_text(input, index) + "; " + figures_text(input, index)));
}

std::string property(std::string_view name, std::string_view value) {
  return fmt::format("      <property name=\"{}\" value=\"{}\"/>\n", name, escaped(value));
}

std::string audit_properties(const AuditTally& audits) {
  std::uint64_t audited = 0, differing = 0;
  for (const AgentAudit& agent : audits.agents()) {
    audited += agent.audited;
    differing += agent.differing;
  }
  return property("audited_runs", std::to_string(audited)) + property("differing_audits", std::to_string(differing));
}

std::string properties(const ReportInput& input) {
  const CampaignRecord& campaign = input.campaign;
  return "    <properties>\n" + property("verdict", name_of(overall_verdict(input.evidence, input.gates))) +
         (input.exit_code ? property("exit_code", std::to_string(*input.exit_code)) : "") +
         property("archive", input.archive_path) +
         property("replicates", fmt::format("{} of {}", input.evidence.complete_replicates(), campaign.replicates)) +
         property("simulated_agv_hours", fmt::format("{:.1f}", all_agv_hours(input.evidence))) +
         property("engine_errors", std::to_string(input.evidence.engine_errors())) +
         audit_properties(input.evidence.audits()) + property("seed", std::to_string(campaign.seed)) +
         property("plan_hash", hex_text(campaign.plan_hash)) + property("fleetproof", campaign.engine.version) +
         property("program_sha256", campaign.engine.program_sha256) + "    </properties>\n";
}

struct Counts {
  std::size_t tests = 0, failures = 0, errors = 0, skipped = 0;
  std::string text() const {
    return fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\"", tests, failures, errors);
  }
};

std::string suite(std::string_view name, std::size_t id, const Counts& counts, const std::string& content) {
  return fmt::format("  <testsuite name=\"{}\" {} skipped=\"{}\" id=\"{}\">\n{}  </testsuite>\n", escaped(name),
                     counts.text(), counts.skipped, id, content);
}

std::string gate_suite(const ReportInput& input, Counts& counts) {
  std::string cases;
  for (std::size_t i = 0; i < input.gates.size(); ++i) {
    const Ending ending = ending_of(input, i);
    ++counts.tests;
    counts.failures += ending == Ending::Failed ? 1 : 0;
    counts.errors += ending == Ending::Error ? 1 : 0;
    counts.skipped += ending == Ending::Skipped ? 1 : 0;
    cases += case_element(input, i);
  }
  for (const std::string& sentence : unjudged_agents(input.evidence)) {
    ++counts.tests;
    ++counts.failures;
    cases += fmt::format(
        "    <testcase name=\"every agent under test is judged\" classname=\"fleetproof\" time=\"0\">\n      <failure "
        "type=\"not judged\" message=\"{}\"/>\n    </testcase>\n",
        escaped(sentence));
  }
  return suite(input.campaign.name, 0, counts, properties(input) + cases);
}

// Known failures are skipped: the gates tell whether they are acceptable.
std::string finding_suite(const ReportInput& input, Counts& counts) {
  std::string cases;
  for (const FailureMechanism& finding : input.findings.record->findings) {
    const std::string message =
        fmt::format("{}: {}; {}", finding.standing, count_text(finding.runs.size(), "failure"), finding.mechanism);
    const std::string outcome = finding.needs_attention
                                    ? fmt::format("      <failure type=\"finding\" message=\"{}\">{}</failure>\n",
                                                  escaped(message), escaped_lines(replay_line(input, finding.run)))
                                    : fmt::format("      <skipped message=\"{}\"/>\n", escaped(message));
    cases +=
        fmt::format("    <testcase name=\"{}\" classname=\"fleetproof.findings.{}\" time=\"0\">\n{}    </testcase>\n",
                    escaped(finding.id + " " + finding.mechanism), escaped(class_step(finding.agent)), outcome);
    ++counts.tests;
    ++(finding.needs_attention ? counts.failures : counts.skipped);
  }
  return suite("findings", 1, counts, cases);
}

}  // namespace

std::string render_junit(const ReportInput& input) {
  Counts of_gates, of_findings;
  std::string suites = gate_suite(input, of_gates);
  if (input.findings.record) suites += finding_suite(input, of_findings);
  const Counts all{of_gates.tests + of_findings.tests, of_gates.failures + of_findings.failures, of_gates.errors, 0};
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"fleetproof\" {}>\n{}</testsuites>\n", all.text(),
      suites);
}

}  // namespace fleetproof
