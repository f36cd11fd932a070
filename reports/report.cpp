#include "reports/report.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "reports/json_report.hpp"
#include "reports/junit_report.hpp"
#include "reports/markdown_report.hpp"
#include "reports/text_report.hpp"
#include "reports/wording.hpp"

namespace fleetproof {
namespace {

constexpr std::array<Entry<RenderReport>, 5> kFormats{{
    {"text", "for a terminal: verdicts first, then tables", render_text},
    {"summary", "for a terminal: the verdicts alone", render_summary},
    {"markdown", "for a CI summary: the same page, with shorter tables", render_markdown},
    {"junit", "for CI: one test case for each gate and finding", render_junit},
    {"json", "for programs: every cell and every figure in full", render_json},
}};

}  // namespace

std::span<const Entry<RenderReport>> report_formats() { return kFormats; }

std::string replay_line(const ReportInput& input, std::uint64_t run_index) {
  return replay_command(input.archive_path, run_index);
}

ReportInput read_report_input(const ArchiveReader& archive, std::string archive_path, const AlsoCount& also) {
  ReportInput input{std::move(archive_path),
                    archive.campaign(),
                    Evidence(archive.plan()),
                    Breakdown(archive.cells()),
                    AuditTally(archive.campaign(), archive.cells()),
                    {},
                    {},
                    0,
                    4};
  const auto count = [&](const RunRecord& run) {
    ++input.stored_runs;
    input.audits.add_run(run);
    if (run.run_index != input.evidence.runs()) return;
    input.evidence.add(run);
    input.breakdown.add(run);
    input.failures.add(run, input.evidence.cells()[run.cell].agent);
    if (also) also(run, input.evidence);
  };
  VisitFolded folded;
  folded.met = [&](std::uint32_t cell, const auto& met) { input.evidence.add_met(cell, met); };
  if (input.evidence.quiet_counts() && !also) {
    folded.quiet = [&](const QuietReplicates& quiet) {
      input.stored_runs += quiet.replicates * quiet.by_cell.size();
      input.evidence.add(quiet);
      input.breakdown.add(quiet);
    };
  }
  archive.for_each_run(count, folded);
  archive.for_each_audit([&](const AuditRecord& audit, bool same) {
    if (audit.run_index < input.evidence.runs()) input.audits.add_audit(audit.run_index, same);
  });
  for (const std::string& agent : archive.campaign().plugin_agents)
    input.audits.add_recordings(agent, archive.recording_count(agent));
  input.gates = input.evidence.judge_all();
  input.exit_code = input.audits.engine_at_fault() ? 3 : exit_code(input.evidence, input.gates);
  return input;
}

}  // namespace fleetproof
