#include "campaign/findings/finding_record.hpp"

#include <algorithm>

#include "campaign/shrink/shrink.hpp"

namespace fleetproof {
namespace {

// Neighbours may fail later than the run that was looked at.
FailingCase with_less_time(FailingCase reduced) {
  const Duration at = reduced.failure.seen - kStart;
  reduced.scenario.horizon = std::min(reduced.scenario.horizon, std::max(2 * at, at + std::chrono::seconds(60)));
  return reduced;
}

}  // namespace

FindingRecord record_of(CaseHost& host, const Finding& finding, const FailureNeeds& representative,
                        std::uint64_t trials) {
  const FailingCase world = with_less_time(representative.reduced);
  FindingRecord record;
  const FailurePattern pattern = pattern_of(host, world);
  TrialCache cache;
  const FailingCase smallest =
      shrink(host, cache, world, pattern, {{}, trials}, [](const FailingCase&, std::string_view) {}).best;
  record.explanation = explain(host, world, smallest, pattern);
  record.kept = {smallest.scenario, world.scenario, finding.mechanism.end, {finding.mechanism.needs}};
  const Neighbourhood neighbourhood(host, record.kept);
  record.neighbours = try_neighbours(host, record.kept, neighbourhood, kNeighbours);
  for (auto& needs : ways_of(host, neighbourhood, record.neighbours)) {
    if (std::ranges::count(record.kept.ways, needs) == 0) record.kept.ways.push_back(std::move(needs));
  }
  return record;
}

}  // namespace fleetproof
