#include "reports/sections/verdict_sentences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>

#include "reports/attempts/attempt_section.hpp"
#include "reports/page/wording.hpp"
#include "reports/sections/coverage_section.hpp"
#include "reports/sections/gate_section.hpp"
#include "reports/sections/head_notes.hpp"
#include "reports/sections/sample_sentence.hpp"

namespace fleetproof {
namespace {

std::vector<std::size_t> deciding_gates(const ReportInput& input, Verdict verdict) {
  std::vector<std::size_t> list;
  for (std::size_t i = 0; i < input.gates.size(); ++i) {
    if (input.evidence.gates()[i].decides && input.gates[i].verdict == verdict) list.push_back(i);
  }
  return list;
}

std::string subject(const ReportInput& input, std::size_t gate) {
  return printable(input.evidence.gates()[gate].agent, 40) + " " + finding_text(input, gate);
}

// "crash", "crash (fleet of 5, loss 40 %)" if the gate names its cells, or "crash (3 gates)".
std::string gates_text(const std::vector<const GateRecord*>& gates) {
  const std::string named =
      gates.size() > 1 ? fmt::format("{} gates", gates.size()) : filter_text(gates.front()->where);
  return std::string(name_of(gates.front()->end_point)) + (named.empty() ? "" : fmt::format(" ({})", named));
}

// "Gates of fleet-ctl: demonstrated: hang; not demonstrated: violation, crash. Reported only, no part of the verdict:
// old-ctl."
std::string gates_by_verdict(const ReportInput& input) {
  using Alike = std::vector<const GateRecord*>;  // gates on one end point
  std::map<std::string, std::map<Verdict, std::vector<Alike>>> by_agent;
  for (std::size_t i = 0; i < input.gates.size(); ++i) {
    const GateRecord& gate = input.evidence.gates()[i];
    if (!gate.decides) continue;
    auto& groups = by_agent[gate.agent][input.gates[i].verdict];
    const auto known =
        std::ranges::find_if(groups, [&](const Alike& group) { return group.front()->end_point == gate.end_point; });
    (known == groups.end() ? groups.emplace_back() : *known).push_back(&gate);
  }
  std::string text;
  for (const auto& [agent, verdicts] : by_agent) {
    std::vector<std::string> parts;
    for (const auto& [verdict, groups] : verdicts) {
      std::vector<std::string> names;
      for (const Alike& group : groups) names.push_back(gates_text(group));
      parts.push_back(fmt::format("{}: {}", name_of(verdict), joined(names)));
    }
    text += fmt::format("Gates of {}: {}. ", printable(agent, 40), joined(parts, "; "));
  }
  std::vector<std::string> others;
  for (const AgentCoverage& agent : input.evidence.agent_coverage()) {
    if (!is_under_test(input.evidence.plan(), agent.agent)) others.push_back(printable(agent.agent, 40));
  }
  if (!others.empty()) text += fmt::format("Reported only, no part of the verdict: {}.", joined(others));
  return text;
}

constexpr std::size_t kGatesTold = 5;

// The gates with the campaign's own verdict speak for it, the first in the sentence itself.
Headline claim(const ReportInput& input) {
  const Verdict verdict = overall_verdict(input.evidence, input.gates);
  const auto speaking = deciding_gates(input, verdict);
  std::size_t deciding = 0;
  for (const Verdict each : {Verdict::Demonstrated, Verdict::Violated, Verdict::NotDemonstrated})
    deciding += deciding_gates(input, each).size();
  Headline headline{name_of(verdict), "", {}};
  if (speaking.empty()) {
    const std::vector<std::string> unjudged = unjudged_agents(input.evidence);
    headline.text = deciding == 0 || unjudged.empty() ? "no gate binds an agent of this campaign." : unjudged[0] + ".";
    headline.details.emplace_back().text = gates_by_verdict(input);
    return headline;
  }
  headline.text = subject(input, speaking.front());
  headline.text += fmt::format(
      ". {} of {} {}", speaking.size(),
      deciding == 1 ? "1 gate (acceptance criterion)" : fmt::format("{} gates (acceptance criteria)", deciding),
      name_of(verdict));
  headline.text += is_weak(input) ? "; the evidence is weak." : ".";
  for (const std::string& sentence : unjudged_agents(input.evidence))
    headline.details.emplace_back().text = fmt::format("Not demonstrated in any case: {}.", sentence);
  headline.details.emplace_back().text = gates_by_verdict(input);
  std::ranges::move(stall_notes(input), std::back_inserter(headline.details));
  std::ranges::move(crash_notes(input), std::back_inserter(headline.details));
  std::ranges::move(meeting_notes(input), std::back_inserter(headline.details));
  std::ranges::move(silence_notes(input), std::back_inserter(headline.details));
  if (!input.waived.floor.empty()) headline.details.push_back({printable(input.waived.floor, 300), ""});
  for (std::size_t i = 0; i < std::min(kGatesTold, speaking.size()); ++i) {
    const GateResult& result = input.gates[speaking[i]];
    std::string text = i == 0 ? "" : subject(input, speaking[i]) + ". ";
    if (verdict != Verdict::Demonstrated) text += fmt::format("Why {}: {}.", name_of(verdict), result.reason);
    if (!result.missing.empty()) text += (text.empty() ? "" : " ") + ("Weak: " + missing_text(result.missing) + ".");
    if (text.empty()) continue;
    headline.details.push_back({text, ""});
    if (result.worst && verdict != Verdict::Demonstrated) {
      Remark& detail = headline.details.back();
      detail.text += " " + worst_run_text(result);
      detail.command = replay_line(input, result.worst->run_index);
    }
  }
  if (speaking.size() > kGatesTold)
    headline.details.emplace_back().text =
        fmt::format("{} more {}: the reasons stand below the table of gates.", speaking.size() - kGatesTold,
                    speaking.size() == kGatesTold + 1 ? "gate" : "gates");
  const std::size_t first = speaking.front();
  if (const auto& cells = input.evidence.cells_of(first); !cells.empty())
    headline.details.push_back({"Sampled: " + sampled(input.evidence, cells) + ".", ""});
  headline.details.emplace_back().text =
      "A world (replicate) is one draw of all that is random. It is run in every cell (test condition).";
  std::ranges::move(soundness_notes(input), std::back_inserter(headline.details));
  std::ranges::move(repeat_notes(input), std::back_inserter(headline.details));
  std::ranges::move(foreign_code_notes(input), std::back_inserter(headline.details));
  std::ranges::move(sensitivity_notes(input), std::back_inserter(headline.details));
  if (const std::string attempts = attempts_headline(input.attempts, input.evidence); !attempts.empty())
    headline.details.emplace_back().text = attempts;
  return headline;
}

using NameOfBody = std::function<std::string(EntityId)>;
// The failure that leads, if it is something else, and what came before it.
std::string cause_text(const FailingRun& run, const NameOfBody& name) {
  const FirstCause& cause = run.cause;
  std::string text;
  const bool leads = run.worst && run.worst->first == cause.at && run.worst->a == cause.a;
  const std::string at = instant_text(cause.at);
  if (run.end == OutcomeClass::Clean) {
    text = "; at " + at;
  } else if (!leads && cause.a.valid()) {
    text = fmt::format("; leading failure, at {}: {}", at, cause.what);
    if (cause.b.valid()) text += fmt::format(" ({} and {})", name(cause.a), name(cause.b));
  }
  text += fmt::format("; before it: {}", name_of(cause.before));
  if (cause.fault) text += ", " + fault_text(cause, name(cause.fault->a));
  return text;
}

}  // namespace

Remark describe(const ReportInput& input, const FailingRun& run) {
  const auto& cell = input.evidence.cells()[run.cell];
  const auto name = [&](EntityId body) { return body_name(body, cell, input.evidence.computers_of(cell.agent)); };
  auto text = fmt::format("run {}: {}", run.run_index,
                          run.end == OutcomeClass::Clean ? info_of(run.incident->kind).name : run.severity());
  if (run.worst && level_of(*run.worst) == ViolationLevel::HazardousContact) {
    text += fmt::format(" at hazardous speed ({:.1f} m/s)",
                        static_cast<double>(run.worst->relative_speed_um_s / 100'000) / 10.0);
  }
  if (run.worst) {
    text += fmt::format(", {} at {} between {} and {}", metres_text(run.worst->min_clearance_um),
                        instant_text(run.worst->closest_at), name(run.worst->a), name(run.worst->b));
    if (run.violations > 1) text += fmt::format(" (the worst of {})", run.violations);
  }
  text += fmt::format("; agent {}, layout {}, fleet of {}, {}", printable(cell.agent, 40), printable(cell.layout, 40),
                      cell.fleet_size, factors_text(run.factors));
  text += cause_text(run, name);
  if (!run.message.empty()) text += fmt::format("; \"{}\"", printable(run.message, 120));
  const std::string debug = debug_command(input.archive_path, run.run_index);
  if (run.end == OutcomeClass::Crash || run.end == OutcomeClass::Hang) return {text, debug};
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
    if (!is_under_test(input.evidence.plan(), agent)) continue;
    list.push_back(
        {"violation",
         fmt::format("agent {} broke the safety distance in {} within the contract region. The most serious:",
                     printable(agent, 40), count_text(runs, "run")),
         {describe(input, worst)}});
  }
  return list;
}

std::vector<Headline> verdicts(const ReportInput& input) {
  if (!input.gates.empty()) return {claim(input)};
  Headline headline{name_of(Verdict::NotDemonstrated),
                    "this campaign has no gate (acceptance criterion), so nothing can be demonstrated.",
                    {}};
  for (auto notes : {stall_notes(input), crash_notes(input)})
    std::ranges::move(notes, std::back_inserter(headline.details));
  return {std::move(headline)};
}

std::vector<Headline> foreign_body_notes(const ReportInput& input) {
  std::vector<Headline> list;
  for (const auto& [agent, runs, worst] : input.evidence.foreign_body_runs()) {
    if (!is_under_test(input.evidence.plan(), agent)) continue;
    list.push_back(
        {"unknown",
         fmt::format("in {} of agent {} within the contract region, all that AGVs came too close to were fallen "
                     "loads, obstacles, and AGVs that lay wrecked on these. No control software is told of such "
                     "bodies, so these runs accuse nobody; bounds count them as failing. The most serious:",
                     count_text(runs, "run"), printable(agent, 40)),
         {describe(input, worst)}});
  }
  return list;
}

}  // namespace fleetproof
