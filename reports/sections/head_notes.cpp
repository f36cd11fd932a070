#include "reports/sections/head_notes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include "reports/evidence/rounding.hpp"
#include "reports/evidence/zero_failure.hpp"
#include "reports/page/wording.hpp"
#include "reports/sections/audit_section.hpp"
#include "reports/sections/condition_table.hpp"
#include "reports/sections/coverage_section.hpp"
#include "reports/sections/sample_sentence.hpp"
#include "reports/sensitivity/sensitivity_section.hpp"

namespace fleetproof {
namespace {

bool has_gate_on_progress(const Evidence& evidence, const std::string& agent) {
  return std::ranges::any_of(evidence.gates(), [&](const GateRecord& gate) {
    return gate.agent == agent && gate.decides && is_stall(gate.end_point);
  });
}

// On all cells of the contract region that the agent has.
bool has_whole_gate_on(const Evidence& evidence, const std::string& agent, EndPoint end_point) {
  return std::ranges::any_of(evidence.gates(), [&](const GateRecord& gate) {
    return gate.agent == agent && gate.decides && gate.end_point == end_point && gate.region != Region::WorstCase &&
           gate.where == CellFilter{};
  });
}

}  // namespace

std::vector<Headline> head_beside_verdict(const ReportInput& input) {
  std::vector<Headline> head = reservations(input);
  for (auto part : {lenient_headlines(input.waived), audit_headlines(input), weak_headlines(input)})
    std::ranges::move(part, std::back_inserter(head));
  std::string troubles = input.evidence.counts_only() ? "" : attempt_troubles(input.attempts);
  if (!troubles.empty()) head.push_back({"sessions", troubles.substr(1), {}});
  return head;
}

std::vector<Remark> stall_notes(const ReportInput& input) {
  std::vector<Remark> notes;
  for (const BreakdownRow& row : input.breakdown.rows()) {
    const bool of_all = row.key.layout.empty() && row.key.fleet_size == 0;
    if (!of_all || !row.key.in_contract || row.stalled == 0) continue;
    if (!is_under_test(input.evidence.plan(), row.key.agent)) continue;
    std::string text = fmt::format(
        "{} stalled in {} of {} worlds of the contract region: AGVs waited for each other (deadlock), moved without a "
        "result (livelock), or one was left without progress (starvation), and no contact explains it.",
        printable(row.key.agent, 40), row.stalled, row.violations.worlds.units);
    if (!has_gate_on_progress(input.evidence, row.key.agent)) text += " No gate judges that.";
    notes.push_back({std::move(text), replay_command(input.archive_path, *row.first_stalled)});
  }
  return notes;
}

std::vector<Remark> crash_notes(const ReportInput& input) {
  std::vector<Remark> notes;
  for (const BreakdownRow& row : input.breakdown.rows()) {
    const bool of_all = row.key.layout.empty() && row.key.fleet_size == 0;
    if (!of_all || !row.key.in_contract || !is_under_test(input.evidence.plan(), row.key.agent)) continue;
    const auto told = [&](std::uint64_t runs, EndPoint end_point, std::string_view what) {
      if (runs == 0 || has_whole_gate_on(input.evidence, row.key.agent, end_point)) return;
      notes.emplace_back().text =
          fmt::format("{} {} in {} of {} runs of the contract region. No gate judges that in all of the region.",
                      printable(row.key.agent, 40), what, runs, row.tally.runs);
    };
    told(row.tally.crash_runs, EndPoint::Crash, "crashed");
    told(row.tally.hang_runs, EndPoint::Hang, "hung");
  }
  return notes;
}

std::vector<Remark> meeting_notes(const ReportInput& input) {
  std::vector<Remark> notes;
  for (const auto& [agent, coverage, missing, incidents] : input.evidence.agent_coverage()) {
    if (!is_under_test(input.evidence.plan(), agent)) continue;
    const std::uint64_t alone = runs_alone(coverage);
    if (2 * alone > coverage.runs())
      notes.emplace_back().text =
          fmt::format("In {} of {} runs of {} no two AGVs met.", alone, coverage.runs(), printable(agent, 40));
    const auto others = runs_beyond_following(coverage);
    if (!others || *others * kRunsPerProbe >= coverage.runs()) continue;
    notes.emplace_back().text = fmt::format(
        "{} only followed other AGVs: {} had drives of two AGVs that came head-on, crossed or merged.",
        printable(agent, 40), *others == 0 ? "no run" : fmt::format("fewer than one in {} runs", kRunsPerProbe));
  }
  return notes;
}

std::vector<Remark> silence_notes(const ReportInput& input) {
  constexpr std::uint64_t kNoticed = 10;                                  // one run in so many
  std::map<std::string, std::pair<std::uint64_t, std::uint64_t>> counts;  // by agent: silent runs, all of two or more
  for (const CellRecord& cell : input.evidence.cells()) {
    if (cell.fleet_size < 2 || !is_under_test(input.evidence.plan(), cell.agent)) continue;
    auto& [silent, all] = counts[cell.agent];
    silent += input.evidence.tally(cell.index).silent_runs;
    all += input.evidence.tally(cell.index).runs;
  }
  std::vector<Remark> notes;
  for (const auto& [agent, count] : counts) {
    const auto [silent, all] = count;
    if (silent == 0 || silent * kNoticed < all) continue;
    notes.emplace_back().text = fmt::format(
        "The AGVs of {} sent no message in {} of {} runs with two or more of them: nothing that the radio loses or "
        "delays could matter there, and what they agreed on, if anything, they did not agree on by radio.",
        printable(agent, 40), silent, all);
  }
  return notes;
}

std::vector<Remark> repeat_notes(const ReportInput& input) {
  std::vector<Remark> notes;
  for (const AgentAudit& audit : input.evidence.audits().agents()) {
    // A reference agent always does the same: a difference would be an error of the engine.
    if (!audit.is_plugin || !is_under_test(input.evidence.plan(), audit.agent)) continue;
    if (audit.audited == 0 || audit.differing > 0) continue;
    const double confidence = bound_rule(input.evidence, audit.agent).confidence;
    notes.emplace_back().text = fmt::format(
        "With {} confidence, at most {} % of the runs of {} would come out otherwise if they were simulated once more: "
        "{} and none did.",
        percent(confidence), rounded_up(100.0 * zero_failure_bound(audit.audited, confidence)),
        printable(audit.agent, 40), audit.audited == 1 ? "1 was," : fmt::format("{} were,", audit.audited));
  }
  return notes;
}

std::vector<Remark> foreign_code_notes(const ReportInput& input) {
  std::vector<std::string> plugins;
  for (const AgentAudit& audit : input.evidence.audits().agents()) {
    if (audit.is_plugin && is_under_test(input.evidence.plan(), audit.agent))
      plugins.push_back(printable(audit.agent, 40));
  }
  if (plugins.empty()) return {};
  return {{fmt::format(
               "{} {} not built in. A shared object runs in the process of the engine that judges, all AGVs in one: "
               "that is safe from accidents, and not from forgery or from AGVs that agree through memory instead of "
               "messages. A lockstep program has a process of its own and cannot forge; its AGVs share that, unless "
               "its command has {{agv}}. It is not seen whether software does otherwise on a vehicle than in "
               "simulation. Digests are those of the named files, not of what these load.",
               joined(plugins), plugins.size() == 1 ? "is" : "are"),
           ""}};
}

std::vector<Remark> soundness_notes(const ReportInput& input) {
  std::uint64_t audited = 0;
  bool in_doubt = input.evidence.engine_errors() > 0;
  for (const AgentAudit& audit : input.evidence.audits().agents()) {
    audited += audit.audited;
    in_doubt = in_doubt || audit.differing > 0;
  }
  std::vector<Remark> notes;
  if (in_doubt) return notes;
  std::string text = "No run ended in an error of the simulator. ";
  text += audited == 0 ? "No run was simulated once more to compare."
                       : fmt::format("{} simulated once more in another process, and came out the same.",
                                     audited == 1 ? "1 run was" : fmt::format("{} runs were", audited));
  notes.emplace_back().text = std::move(text);
  return notes;
}

std::vector<Remark> sensitivity_notes(const ReportInput& input) {
  const auto& [record, trouble] = input.sensitivity;
  if (!record && trouble.empty())
    return {{"Which planted faults these worlds detect was not measured; `fleetproof sensitivity` does that.", ""}};
  if (!record) return {{printable(trouble, 400), ""}};
  return {{fmt::format("Tried with planted faults, a campaign in these worlds {}. A file beside this one says so; no "
                       "seal covers it.",
                       sensitivity_sentence(*record)),
           ""}};
}

}  // namespace fleetproof
