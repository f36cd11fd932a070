#include "campaign/findings/failure_analysis.hpp"

#include <algorithm>
#include <utility>

#include "campaign/findings/elsewhere.hpp"
#include "campaign/findings/ingredients.hpp"
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
void keep_what_it_shows(const std::optional<FailureNeeds>& of_case, const Finding& finding,
                        const FailurePattern& pattern, KeptFailure& kept) {
  kept.says = pattern.words.telling;
  if (!of_case) return;
  if (names_all(of_case->doings, {finding.mechanism.doing})) kept.doings.push_back(finding.mechanism.doing);
  const bool third =
      names_all(of_case->traits, {kThirdAgvTrait}) && names_all(finding.mechanism.traits, {kThirdAgvTrait});
  if (third) kept.doings.emplace_back(kThirdAgvTrait);
}

}  // namespace

void keep_words_of_all(KeptFailure& kept, const NeighbourCounts& neighbours) {
  if (neighbours.alike == 0) return;
  std::erase_if(kept.says,
                [&](const std::string& word) { return std::ranges::count(neighbours.said.always, word) == 0; });
}

FailureAnalysis analysis_of(CaseHost& host, const Finding& finding, const FailureNeeds& representative,
                            std::uint64_t trials, const FurtherFailures& worlds) {
  const FailingCase world = with_less_time(representative.reduced);
  FailureAnalysis record;
  const FailurePattern pattern = pattern_of(host, world);
  TrialCache cache;
  const ShrinkResult small = shrink(host, cache, world, pattern, {trials}, [](const FailingCase&, std::string_view) {});
  const FailingCase& smallest = small.best;
  record.explanation = explain(host, world, small, pattern);
  record.kept = {smallest.scenario, world.scenario, finding.mechanism.end, {finding.mechanism.needs}};
  auto of_case = needs_of(host, record.kept.smallest);
  keep_what_it_shows(of_case, finding, pattern, record.kept);
  const auto add_world = [&](const FailingCase& other) {
    record.kept.other_worlds.push_back(with_less_time(other).scenario);
  };
  std::ranges::for_each(worlds.others, add_world);
  std::ranges::for_each(same_failure_elsewhere(host, record.kept, kOtherWorlds - worlds.others.size()), add_world);
  const Neighbourhood neighbourhood(host, record.kept);
  record.neighbours = try_enough_neighbours(host, record.kept, neighbourhood);
  record.neighbours.driven_elsewhere_m = driven_elsewhere_m(host, record.kept);
  keep_words_of_all(record.kept, record.neighbours);
  const auto add_way = [&](std::vector<std::string> needs) {
    if (std::ranges::count(record.kept.ways, needs) == 0) record.kept.ways.push_back(std::move(needs));
  };
  const NeighbourCounts& neighbours = record.neighbours;
  for (const auto* first : {&neighbours.first_alike, &neighbours.first_alike_of_world}) {
    for (FailureNeeds& found : needs_of_neighbours(host, neighbourhood, *first)) add_way(std::move(found.needs));
  }
  // The smallest case may do with less than its finding needs. With the same software, it is one of them.
  if (of_case) add_way(std::move(of_case->needs));
  record.kept.runs = worlds.runs;
  record.whole_runs = try_whole_runs(host, record.kept);
  record.others_need = needs_of_others(host, record.kept, record.whole_runs);
  return record;
}

std::vector<std::size_t> other_members(const Finding& finding, std::span<const KnownFailure> failures) {
  std::vector<std::size_t> members = finding.members;
  std::erase_if(members, [&](std::size_t i) { return i == finding.representative || failures[i].needs.is_rare; });
  std::vector<std::size_t> others;
  const std::size_t count = std::min(kOtherWorlds, members.size());
  for (std::size_t i = 0; i < count; ++i) others.push_back(members[(2 * i + 1) * members.size() / (2 * count)]);
  return others;
}

std::vector<FailingCase> others_of(const Finding& finding, std::span<const KnownFailure> failures) {
  std::vector<FailingCase> others;
  for (const std::size_t member : other_members(finding, failures)) others.push_back(failures[member].needs.reduced);
  return others;
}

}  // namespace fleetproof
