#include "campaign/findings/whole_failures.hpp"

#include <algorithm>
#include <utility>

#include "campaign/findings/ingredients.hpp"

namespace fleetproof {

NeighbourCounts try_whole_runs(CaseHost& host, const KeptFailure& kept, std::uint32_t count) {
  if (kept.runs.empty()) return {};
  return try_neighbours(host, kept, Neighbourhood::of_runs(kept), std::min(count, kWholeRuns));
}

bool may_be(const KeptFailure& kept, const FailureNeeds& found) {
  const bool is_with_third = names_all(kept.doings, {kThirdAgvTrait}) && !names_all(found.traits, {kThirdAgvTrait});
  if (found.end != kept.end || is_with_third || !names_all(found.said, kept.says)) return false;
  const auto named = without_kinds(found.needs);
  return std::ranges::any_of(kept.ways, [&](const std::vector<std::string>& way) {
    const auto some = without_kinds(way);
    return some.empty() ? way.empty() == found.needs.empty() : names_all(named, some);
  });
}

std::vector<std::vector<std::string>> needs_of_others(CaseHost& host, const KeptFailure& kept,
                                                      const NeighbourCounts& counts) {
  std::vector<std::vector<std::string>> all;
  for (FailureNeeds& found : needs_of_neighbours(host, Neighbourhood::of_runs(kept), counts.first_alike)) {
    if (!found.is_rare && !may_be(kept, found) && std::ranges::count(all, found.needs) == 0)
      all.push_back(std::move(found.needs));
  }
  return all;
}

}  // namespace fleetproof
