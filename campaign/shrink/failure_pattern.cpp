#include "campaign/shrink/failure_pattern.hpp"

#include <algorithm>
#include <utility>

#include "campaign/shrink/adverse_deliveries.hpp"
#include "campaign/shrink/other_draws.hpp"

namespace fleetproof {
namespace {

constexpr std::uint32_t kRunsWithOtherDraws = 16;

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
  std::vector<CaseRun> others;
  for (std::uint32_t i = 1; i <= kRunsWithOtherDraws && !run.words.empty(); ++i) {
    others.push_back(host(with_other_timeline(failing.scenario, i, kLatest)));
    if (!failure_of(others.back())) learner.hear_passing(others.back());
  }
  FailurePattern pattern{failing.failure.kind, failing.failure.kind.states, {{}, learner.pattern().usual}};
  std::erase_if(pattern.states, [&](const std::string& state) { return learner.is_ordinary(state); });
  auto& states = pattern.states;  // they are sorted
  states.erase(std::unique(states.begin(), states.end()), states.end());
  for (const CaseRun& other : others) {
    if (pattern.match(other)) learner.hear_failing(other);
  }
  pattern.words = learner.pattern();
  if (undisturbed_fails && learner.passing() == 0) pattern.words.telling.clear();  // nothing to compare with
  return pattern;
}

}  // namespace fleetproof
