#include "reports/sections/report_input.hpp"

#include <utility>

#include "core/base/error.hpp"
#include "reports/page/wording.hpp"

namespace fleetproof {

std::string replay_line(const ReportInput& input, std::uint64_t run_index) {
  return replay_command(input.archive_path, run_index);
}

ReportInput read_report_input(const ArchiveReader& archive, std::string archive_path, const AlsoCount& also) {
  ReportInput input{
      std::move(archive_path), archive.campaign(), Evidence(archive.plan()), Breakdown(archive.plan()), {}, {}, 0};
  const auto count = [&](const RunRecord& run) {
    ++input.stored_runs;
    if (run.run_index != input.evidence.runs()) return;
    input.evidence.add(run);
    input.breakdown.add(run);
    input.failures.add(run, input.evidence.cells()[run.cell].agent);
    if (also) also(run, input.evidence);
  };
  archive.for_each_audit([&](const AuditRecord& audit, bool same) { input.evidence.know(AuditedRun{audit, same}); });
  input.evidence.know_unplaced_repeats(archive.unplaced_repeats());
  if (!archive.is_published()) input.evidence.know_unsealed();
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
  for (const std::string& agent : archive.campaign().plugin_agents)
    input.evidence.know_recordings(agent, archive.recording_count(agent));
  input.seal = archive.seal();
  input.gates = input.evidence.judge_all();
  return input;
}

Conclusion conclusion_of(const ReportInput& input) {
  if (input.evidence.engine_errors() > 0 || input.evidence.audits().engine_at_fault()) return Conclusion::EngineFault;
  switch (overall_verdict(input.evidence, input.gates)) {
    case Verdict::Demonstrated:
      return Conclusion::Demonstrated;
    case Verdict::Violated:
      return Conclusion::Violated;
    case Verdict::NotDemonstrated:
      return Conclusion::NotDemonstrated;
  }
  invariant_violated("a verdict concludes a campaign");
}

}  // namespace fleetproof
