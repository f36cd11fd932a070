#include "campaign/shrink/failure_pattern.hpp"

#include <algorithm>
#include <utility>

#include "campaign/shrink/adverse_deliveries.hpp"
#include "campaign/shrink/all_runs.hpp"
#include "campaign/shrink/other_draws.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kRunsWithOtherDraws = 16;

}  // namespace

std::optional<Failure> FailurePattern::match(const CaseRun& run) const {
  auto failure = failure_of(run);
  if (!failure || failure->kind.what != kind.what || !std::ranges::includes(failure->kind.states, states) ||
      !words.match(run.words))
    return std::nullopt;
  return failure;
}

FailurePattern pattern_of(CaseHost& host, const FailingCase& failing) {
  const CaseRun run = host(failing.scenario);
  WordLearner learner(run);
  const CaseRun undisturbed = host(with_deliveries_only(failing.scenario, {}));
  const bool undisturbed_fails = failure_of(undisturbed).has_value();
  if (!undisturbed_fails) learner.hear_undisturbed(undisturbed);
  const auto other = [&](std::size_t i) {
    return std::optional(with_other_timeline(failing.scenario, static_cast<std::uint32_t>(i + 1), kLatest));
  };
  const auto others = all_runs(host, {run.words.empty() ? 0 : kRunsWithOtherDraws, other});
  for (const auto& passing : others) {
    if (!failure_of(*passing)) learner.hear_passing(*passing);
  }
  FailurePattern pattern{failing.failure.kind, failing.failure.kind.states, {{}, learner.pattern().usual}};
  std::erase_if(pattern.states, [&](const std::string& state) { return learner.is_ordinary(state); });
  auto& states = pattern.states;  // they are sorted
  states.erase(std::unique(states.begin(), states.end()), states.end());
  for (const auto& alike : others) {
    if (pattern.match(*alike)) learner.hear_failing(*alike);
  }
  pattern.words = learner.pattern();
  if (undisturbed_fails && learner.passing() == 0) pattern.words.telling.clear();  // nothing to compare with
  return pattern;
}

}  // namespace fleetproof
