#include "campaign/findings/keeper.hpp"

#include <algorithm>

namespace fleetproof {
namespace {

// Neighbours may fail later than the run that was looked at.
Duration horizon_of(const FailingCase& reduced) {
  const Duration at = reduced.failure.at - kStart;
  return std::min(reduced.scenario.horizon, std::max(2 * at, at + std::chrono::seconds(60)));
}

}  // namespace

FindingRecord record_of(CaseHost& host, const Finding& finding, const FailureNeeds& representative,
                        std::uint64_t trials) {
  const FailingCase& reduced = representative.reduced;
  FindingRecord record;
  const FailurePattern pattern = pattern_of(host, reduced);
  TrialCache cache;
  record.shrunk = shrink(host, cache, reduced, pattern, {{}, trials}, [](const FailingCase&, std::string_view) {});
  record.explanation = explain(host, reduced, record.shrunk.best, pattern);
  record.kept = {record.shrunk.best.scenario, reduced.scenario, finding.mechanism.end, {finding.mechanism.needs}};
  record.kept.world.horizon = horizon_of(reduced);
  const Neighbourhood neighbourhood(host, record.kept);
  record.neighbours = try_neighbours(host, record.kept, neighbourhood, kNeighbours);
  for (auto& needs : ways_of(host, neighbourhood, record.neighbours)) {
    if (std::ranges::count(record.kept.ways, needs) == 0) record.kept.ways.push_back(std::move(needs));
  }
  return record;
}

}  // namespace fleetproof
