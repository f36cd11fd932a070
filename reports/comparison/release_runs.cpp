#include "reports/comparison/release_runs.hpp"

#include <algorithm>

#include "reports/evidence/evidence.hpp"
#include "reports/evidence/exposure.hpp"

namespace fleetproof {

bool ComparedRun::is_clean() const {
  return std::ranges::all_of(results, [](RunResult result) { return result == RunResult::Passed; });
}

std::vector<std::string> agents_to_compare(const ArchiveReader& archive) {
  std::vector<std::string> agents;
  for (const CellRecord& cell : archive.cells()) {
    if (is_under_test(archive.plan(), cell.agent) && std::ranges::find(agents, cell.agent) == agents.end())
      agents.push_back(cell.agent);
  }
  return agents;
}

ReleaseRuns read_release(const ArchiveReader& archive, std::string path, const std::string& agent) {
  ReleaseRuns release{std::move(path), agent, archive.campaign(), {}, {}, 0, 0, archive.unplaced_repeats() > 0};
  for (const CellRecord& cell : archive.cells()) {
    if (cell.agent == agent) release.cells.push_back(cell);
  }
  const std::size_t cells = archive.cells().size();
  archive.for_each_audit([&](const AuditRecord& audit, bool same) {
    if (archive.cells()[audit.run_index % cells].agent != agent) return;
    ++release.audited;
    release.differing += same ? 0 : 1;
  });
  std::uint64_t next = 0;  // the runs before the first gap count
  std::vector<ComparedRun> replicate;
  archive.for_each_run([&](const RunRecord& run) {
    if (run.run_index != next) return;
    ++next;
    if (archive.cells()[run.cell].agent == agent) {
      ComparedRun& compared = replicate.emplace_back();
      compared.run_index = run.run_index;
      for (std::size_t i = 0; i < kComparedEndPoints.size(); ++i)
        compared.results[i] = kComparedEndPoints[i] == EndPoint::Throughput
                                  ? RunResult::Passed
                                  : result_of(run.outcome, kComparedEndPoints[i]);
      compared.transports_done = run.outcome.counters.transports_done;
      compared.repeats = run.repeats;
      compared.agv_us = agv_us(run.outcome.simulated_ns, run.outcome.agv_count);
    }
    if (run.cell + 1 == archive.cells().size()) {
      release.replicates.push_back(std::move(replicate));
      replicate.clear();
    }
  });
  return release;
}

}  // namespace fleetproof
