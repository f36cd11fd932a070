#include "campaign/shrink/all_runs.hpp"

#include <utility>

#include "campaign/batch/task_pool.hpp"

namespace fleetproof {

std::vector<std::optional<CaseRun>> all_runs(CaseHost& host, const Candidates& candidates, Deliveries deliveries) {
  std::vector<std::optional<CaseRun>> runs(candidates.count);
  TaskPool<CaseRun> pool({.workers = host.workers(), .end = candidates.count, .window = candidates.count + 1},
                         [&](std::uint64_t rank) {
                           const auto scenario = candidates.make(rank);
                           return scenario ? std::optional(host(*scenario, deliveries)) : std::nullopt;
                         });
  pool.take_all([&](std::uint64_t rank, CaseRun run) { runs[rank] = std::move(run); });
  return runs;
}

}  // namespace fleetproof
