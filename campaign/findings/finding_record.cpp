#include "campaign/findings/finding_record.hpp"

#include <algorithm>
#include <utility>

#include "campaign/shrink/shrink.hpp"

namespace fleetproof {
namespace {

// Neighbours may fail later than the run that was looked at.
FailingCase with_less_time(FailingCase reduced) {
  const Duration at = reduced.failure.seen - kStart;
  reduced.scenario.horizon = std::min(reduced.scenario.horizon, std::max(2 * at, at + std::chrono::seconds(60)));
  return reduced;
}

// Other software that fails without this fails for another reason. Shrinking keeps the words; what the bodies do may
// have changed on its way.
void keep_what_it_shows(CaseHost& host, const Finding& finding, const FailurePattern& pattern, KeptFailure& kept) {
  kept.says = pattern.words.telling;
  const auto done = doings_of(host(kept.smallest));
  if (std::ranges::count(done, finding.mechanism.doing) > 0) kept.doings = {finding.mechanism.doing};
}

}  // namespace

void keep_words_of_all(KeptFailure& kept, const NeighbourCounts& neighbours) {
  if (neighbours.alike == 0) return;
  std::erase_if(kept.says,
                [&](const std::string& word) { return std::ranges::count(neighbours.always_said, word) == 0; });
}

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
  keep_what_it_shows(host, finding, pattern, record.kept);
  const Neighbourhood neighbourhood(host, record.kept);
  record.neighbours = try_enough_neighbours(host, record.kept, neighbourhood);
  keep_words_of_all(record.kept, record.neighbours);
  const auto add_way = [&](std::vector<std::string> needs) {
    if (std::ranges::count(record.kept.ways, needs) == 0) record.kept.ways.push_back(std::move(needs));
  };
  for (FailureNeeds& found : needs_of_first(host, neighbourhood, record.neighbours)) add_way(std::move(found.needs));
  // The smallest case may do with less than its finding needs. With the same software, it is one of them.
  if (auto of_case = needs_of(host, record.kept.smallest)) add_way(std::move(of_case->needs));
  return record;
}

}  // namespace fleetproof
