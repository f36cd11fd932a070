#include "reports/sections/audit_section.hpp"

#include <fmt/format.h>

#include <utility>

#include "reports/page/wording.hpp"

namespace fleetproof {
namespace {

// "2.1 % of the audited runs (3 of 143)".
std::string share_text(const AgentAudit& audit) {
  return fmt::format("{:.1f} % of the audited runs ({} of {})",
                     100.0 * static_cast<double>(audit.differing) / static_cast<double>(audit.audited), audit.differing,
                     audit.audited);
}

std::string recordings_text(const AgentAudit& audit) {
  if (audit.failed_runs == 0) return "None of its runs failed.";
  return fmt::format("{} of {} can be replayed from a recording of what the agent did.", audit.recordings,
                     count_text(audit.failed_runs, "failed run"));
}

Headline headline_of(const ReportInput& input, const AgentAudit& audit) {
  const std::string agent = printable(audit.agent, 40);
  if (audit.engine_at_fault()) {
    Headline headline{"engine error",
                      fmt::format("runs of the reference agent {} came out differently in {}: nothing here is evidence "
                                  "until that error is corrected.",
                                  agent, share_text(audit)),
                      {}};
    headline.details.push_back({fmt::format("The first of them is run {}:", *audit.first_differing),
                                replay_line(input, *audit.first_differing)});
    return headline;
  }
  const bool is_dependent = depends_on_earlier_runs(input, audit);
  std::string text = fmt::format("agent {}: this software {} in {}, first in run {}. ", agent,
                                 is_dependent ? "depends on earlier runs of the same process" : "is not deterministic",
                                 share_text(audit), *audit.first_differing);
  if (is_dependent)
    text +=
        "In new processes a run came out the same, and otherwise in those that had served other runs. What the "
        "software keeps has to be set back when a run begins. A lockstep program has a new process for each run if "
        "its hello says \"runs\": \"one\". ";
  text += audit.judged_otherwise == 0
              ? "All of them were judged alike, so its rates stand; what an AGV does at an instant may differ. "
              : fmt::format(
                    "{} of them {} judged otherwise: another end point failed, or none did. So nothing is "
                    "demonstrated for it. ",
                    audit.judged_otherwise, audit.judged_otherwise == 1 ? "was" : "were");
  if (audit.judged_otherwise == 0 && audit.promises_to_repeat)
    text += "It declares that it always does the same, so nothing is demonstrated for it. ";
  return {is_dependent ? "depends on earlier runs" : "not deterministic", text + recordings_text(audit), {}};
}

std::string remark_of(const ReportInput& input, const AgentAudit& audit) {
  const std::string agent = printable(audit.agent, 40);
  const std::string open = audit.open == 0 ? "" : fmt::format(" {} due and not done.", count_text(audit.open, "audit"));
  if (audit.audited == 0) return fmt::format("Agent {}: no run was audited.{}", agent, open);
  if (audit.differing == 0)
    return audit.audited == 1 ? fmt::format("Agent {}: 1 run was audited, and it came out the same.{}", agent, open)
                              : fmt::format("Agent {}: {} runs were audited, and every one came out the same.{}", agent,
                                            audit.audited, open);
  if (audit.engine_at_fault()) return fmt::format("Agent {}: an error of the engine in {}.", agent, share_text(audit));
  const char* what =
      depends_on_earlier_runs(input, audit) ? "depends on earlier runs of the same process" : "not deterministic";
  return fmt::format("Agent {}: {} in {}. {}{}", agent, what, share_text(audit), recordings_text(audit), open);
}

}  // namespace

bool depends_on_earlier_runs(const ReportInput& input, const AgentAudit& audit) {
  return audit.differing > 0 && !input.attempts.log_is_foreign && input.attempts.dependent_agents.contains(audit.agent);
}

std::vector<Headline> audit_headlines(const ReportInput& input) {
  std::vector<Headline> list;
  for (const AgentAudit& audit : input.evidence.audits().agents()) {
    if (audit.differing > 0) list.push_back(headline_of(input, audit));
    if (audit.processor_changed_runs > 0)
      list.push_back({"processor changed",
                      fmt::format("agent {}: in {} it left another rounding, other floating-point exceptions or other "
                                  "denormals behind. They were set back after each call, so no other software computed "
                                  "with them, but on a vehicle this software may.",
                                  printable(audit.agent, 40), count_text(audit.processor_changed_runs, "run")),
                      {}});
    if (audit.open > 0 && is_under_test(input.evidence.plan(), audit.agent))
      list.push_back({"audits open",
                      fmt::format("agent {}: {} due and not done: nothing is demonstrated for it before they are. The "
                                  "same command goes on with them.",
                                  printable(audit.agent, 40), count_text(audit.open, "audit")),
                      {}});
  }
  return list;
}

Section audit_section(const ReportInput& input) {
  Section section{"Can the runs be repeated?", {}, {}};
  std::string what =
      "An audit simulates a run once more: in another process, with other addresses, other bytes in fresh memory, and "
      "in another order of runs.";
  section.remarks.emplace_back().text = std::move(what);
  for (const AgentAudit& audit : input.evidence.audits().agents())
    section.remarks.push_back({remark_of(input, audit), ""});
  return section;
}

}  // namespace fleetproof
