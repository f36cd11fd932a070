#include "reports/evidence/failure_groups.hpp"

#include <algorithm>

#include "reports/evidence/evidence.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kMostDigests = 200'000;  // in all groups together: some 10 MB

}  // namespace

void FailureGroups::add(const RunRecord& run, const std::string& agent) {
  const auto failing = FailingRun::of(run);
  if (!failing) return;
  ++failing_runs_;
  const FirstCause& cause = failing->cause;
  auto [place, is_new] = groups_.try_emplace({agent, failing->end, cause.what, cause.before});
  Group& group = place->second;
  if (is_new) group.shown = {agent, failing->severity(), cause.what, cause.before, 0, 0, false, *failing};
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
  }
  std::ranges::stable_sort(all,
                           [](const FailureGroup& a, const FailureGroup& b) { return more_serious(a.worst, b.worst); });
  std::stable_partition(all.begin(), all.end(),
                        [&](const FailureGroup& group) { return is_under_test(plan, group.agent); });
  return all;
}

}  // namespace fleetproof
