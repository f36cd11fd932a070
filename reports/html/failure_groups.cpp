#include "reports/html/failure_groups.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fleetproof::html {
namespace {

constexpr std::size_t kMostDigests = 200'000;  // in all groups together: some 10 MB

std::string pair_text(EntityId a, EntityId b, std::uint32_t agvs) {
  if (!a.valid() && !b.valid()) return "";
  if (!a.valid() || !b.valid()) return ", one body";
  return a.value < agvs && b.value < agvs ? ", two AGVs" : ", AGV and another body";
}

}  // namespace

std::string first_cause(const RunRecord& run, const FailingRun& failing) {
  const auto& outcome = run.outcome;
  const auto first =
      std::ranges::min_element(outcome.violations, {}, [](const Violation& violation) { return violation.first; });
  const bool has_violation = first != outcome.violations.end();
  if (failing.incident && (!has_violation || failing.incident->first < first->first)) {
    const auto& incident = *failing.incident;
    return fmt::format("{}{}", info_of(incident.kind).name, pair_text(incident.a, incident.b, outcome.agv_count));
  }
  if (has_violation) return name_of(level_of(*first)) + pair_text(first->a, first->b, outcome.agv_count);
  return "nothing that a law (monitor) names";
}

void FailureGroups::add(const RunRecord& run, const std::string& agent) {
  const auto failing = FailingRun::of(run);
  if (!failing) return;
  ++failing_runs_;
  const std::string cause = first_cause(run, *failing);
  auto [place, is_new] = groups_.try_emplace({agent, failing->severity, cause});
  Group& group = place->second;
  if (is_new) group.shown = {agent, name_of(failing->severity), cause, 0, 0, false, *failing};
  ++group.shown.runs;
  if (more_serious(*failing, group.shown.worst)) group.shown.worst = *failing;
  if (digests_ < kMostDigests) {
    digests_ += group.digests.insert(run.outcome.digest).second ? 1 : 0;
  } else if (!group.digests.contains(run.outcome.digest)) {
    group.shown.at_least = true;
  }
}

std::vector<FailureGroup> FailureGroups::list() const {
  std::vector<FailureGroup> all;
  for (const auto& [key, group] : groups_) {
    all.push_back(group.shown);
    all.back().distinct = std::max<std::uint64_t>(group.digests.size(), 1);
  }
  std::ranges::stable_sort(all,
                           [](const FailureGroup& a, const FailureGroup& b) { return more_serious(a.worst, b.worst); });
  return all;
}

}  // namespace fleetproof::html
