#include "reports/evidence/failure_groups.hpp"

#include <algorithm>
#include <iterator>

#include "reports/evidence/evidence.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kMostDigests = 200'000;  // in all groups together: some 10 MB
constexpr std::size_t kMostKept = 100;         // of a group: as many as `report --cases` shows

}  // namespace

void FailureGroups::add(const RunRecord& run, const std::string& agent) {
  const auto failing = FailingRun::of(run);
  if (!failing) return;
  ++failing_runs_;
  const FirstCause& cause = failing->cause;
  auto [place, is_new] =
      groups_.try_emplace({agent, failing->end, cause.what, cause.before}, Group{{}, WorstRuns(kMostKept), {}});
  Group& group = place->second;
  if (is_new) group.shown = {agent, failing->severity(), cause.what, cause.before, 0, 0, false, *failing, {}};
  group.first.add(*failing);
  ++group.shown.runs;
  if (more_serious(*failing, group.shown.worst)) group.shown.worst = *failing;
  if (digests_ < kMostDigests) {
    digests_ += group.digests.insert(run.outcome.digest).second ? 1 : 0;
  } else if (!group.digests.contains(run.outcome.digest)) {
    group.shown.at_least = true;
  }
}

std::vector<FailureGroup> FailureGroups::list(const StoredPlan& plan) const {
  std::vector<FailureGroup> all;
  for (const auto& [key, group] : groups_) {
    all.push_back(group.shown);
    all.back().distinct = std::max<std::uint64_t>(group.digests.size(), 1);
    std::unordered_set<std::uint64_t> seen;
    std::ranges::copy_if(group.first.list(), std::back_inserter(all.back().first),
                         [&](const FailingRun& run) { return seen.insert(run.digest).second; });
  }
  std::ranges::stable_sort(all,
                           [](const FailureGroup& a, const FailureGroup& b) { return more_serious(a.worst, b.worst); });
  std::stable_partition(all.begin(), all.end(),
                        [&](const FailureGroup& group) { return is_under_test(plan, group.agent); });
  return all;
}

std::vector<std::uint64_t> runs_to_show(const std::vector<FailureGroup>& groups, std::size_t most) {
  std::vector<std::uint64_t> runs;
  bool goes_on = true;
  for (std::size_t turn = 0; goes_on && runs.size() < most; ++turn) {
    goes_on = false;
    for (const FailureGroup& group : groups) {
      if (group.first.size() <= turn || runs.size() == most) continue;
      runs.push_back(group.first[turn].run_index);
      goes_on = true;
    }
  }
  return runs;
}

}  // namespace fleetproof
