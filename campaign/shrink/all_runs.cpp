#include "campaign/shrink/all_runs.hpp"

#include <chrono>

#include "campaign/batch/task_pool.hpp"

namespace fleetproof {

// Each task writes to its own place.
std::vector<std::optional<CaseRun>> all_runs(CaseHost& host, const Candidates& candidates, Fates fates) {
  std::vector<std::optional<CaseRun>> runs(candidates.count);
  TaskPool pool(host.workers(), 0, candidates.count, candidates.count + 1, [&](std::uint64_t rank) {
    if (const auto scenario = candidates.make(rank)) runs[rank] = host(*scenario, fates);
    return std::optional(RunRecord{});
  });
  while (!pool.finished()) pool.next(std::chrono::milliseconds(50));
  return runs;
}

}  // namespace fleetproof
