#include "reports/junit_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/markup_text.hpp"
#include "core/base/outside_text.hpp"
#include "reports/gate_section.hpp"
#include "reports/wording.hpp"

namespace fleetproof {
namespace {

// In one line.
std::string escaped(std::string_view text) { return escaped_for_markup(printable(text)); }

std::string escaped_lines(std::string_view text) { return escaped_for_markup(printable_lines(text)); }

enum class Ending { Passed, Failed, Skipped, Error };

Ending ending_of(const ReportInput& input, std::size_t gate) {
  const GateResult& result = input.gates[gate];
  if (input.exit_code == 3) return Ending::Error;
  const bool tested = result.counts.cells > 0 && !result.counts.met_nobody;
  if (!input.evidence.gates()[gate].decides || (!tested && result.verdict != Verdict::Violated)) return Ending::Skipped;
  return result.verdict == Verdict::Demonstrated ? Ending::Passed : Ending::Failed;
}

double simulated_s(const ReportInput& input, std::size_t gate) {
  double agv_s = 0.0;
  for (const std::uint32_t cell : input.evidence.cells_of(gate))
    agv_s += static_cast<double>(input.evidence.tally(cell).agv_us) / 1e6;
  return agv_s;
}

// Readers show the content of an element or its message, but not both.
std::string outcome_element(const ReportInput& input, std::size_t index) {
  const GateRecord& gate = input.evidence.gates()[index];
  const GateResult& result = input.gates[index];
  const std::string message = fmt::format("{}: {} {}", name_of(result.verdict), gate.agent, finding_text(input, index));
  std::string text = fmt::format("{}\nWhy: {}.", message, result.reason);
  if (result.worst) text += "\n" + replay_line(input, result.worst->run_index);
  switch (ending_of(input, index)) {
    case Ending::Passed:
      return "";
    case Ending::Failed:
      return fmt::format("      <failure type=\"{}\" message=\"{}\">{}</failure>\n", escaped(name_of(result.verdict)),
                         escaped(message), escaped_lines(text));
    case Ending::Skipped:
      return fmt::format(
          "      <skipped message=\"{}\"/>\n",
          escaped(gate.decides ? "not put to the test: " + result.reason : "told only, a reference agent: " + message));
    case Ending::Error:
      return fmt::format("      <error type=\"engine error\" message=\"{}\"/>\n",
                         escaped("the engine met an error of its own: nothing here is evidence"));
  }
  return "";
}

// "all.ring.fleet of 5, loss 40 %, delay 0,5 s": readers make a folder of every part, and a part ends at a point.
std::string where_text(const GateRecord& gate) {
  std::string text = name_of(gate.region);
  if (!gate.where.layout.empty()) text += "." + gate.where.layout;
  CellFilter others = gate.where;
  others.layout.clear();
  std::string named = filter_text(others);
  if (named.empty()) return text;
  std::ranges::replace(named, '.', ',');
  return text + "." + named;
}

std::string case_element(const ReportInput& input, std::size_t index) {
  const GateRecord& gate = input.evidence.gates()[index];
  std::string name = gate.name;
  if (!gate.requirement.empty()) name += " [" + gate.requirement + "]";
  return fmt::format(
      "    <testcase name=\"{}\" classname=\"fleetproof.{}.{}\" time=\"{:.3f}\">\n{}"
      "      <system-out>{}</system-out>\n    </testcase>\n",
      escaped(name), escaped(where_text(gate)), escaped(gate.agent), simulated_s(input, index),
      outcome_element(input, index), escaped(gate.agent + " " + finding_text(input, index)));
}

std::string property(std::string_view name, std::string_view value) {
  return fmt::format("      <property name=\"{}\" value=\"{}\"/>\n", name, escaped(value));
}

std::string properties(const ReportInput& input) {
  const CampaignRecord& campaign = input.campaign;
  return "    <properties>\n" + property("verdict", name_of(overall_verdict(input.evidence, input.gates))) +
         property("replicates", fmt::format("{} of {}", input.evidence.complete_replicates(), campaign.replicates)) +
         property("seed", std::to_string(campaign.seed)) + property("plan_hash", hex_text(campaign.plan_hash)) +
         property("fleetproof", campaign.engine.version) + property("program_sha256", campaign.engine.program_sha256) +
         "    </properties>\n";
}

}  // namespace

std::string render_junit(const ReportInput& input) {
  std::size_t failures = 0, errors = 0, skipped = 0;
  double time_s = 0.0;
  std::string cases;
  for (std::size_t i = 0; i < input.gates.size(); ++i) {
    const Ending ending = ending_of(input, i);
    failures += ending == Ending::Failed ? 1 : 0;
    errors += ending == Ending::Error ? 1 : 0;
    skipped += ending == Ending::Skipped ? 1 : 0;
    time_s += simulated_s(input, i);
    cases += case_element(input, i);
  }
  const std::string counts =
      fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\"", input.gates.size(), failures, errors);
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"fleetproof\" {0} time=\"{1:.3f}\">\n"
      "  <testsuite name=\"{2}\" {0} skipped=\"{3}\" time=\"{1:.3f}\" id=\"0\">\n{4}{5}  </testsuite>\n</testsuites>\n",
      counts, time_s, escaped(input.campaign.name), skipped, properties(input), cases);
}

}  // namespace fleetproof
