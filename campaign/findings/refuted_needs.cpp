#include "campaign/findings/refuted_needs.hpp"

#include <algorithm>
#include <functional>
#include <optional>

#include "campaign/findings/ingredients.hpp"
#include "campaign/shrink/all_runs.hpp"
#include "campaign/shrink/fitness.hpp"
#include "campaign/shrink/other_draws.hpp"
#include "campaign/shrink/surgery.hpp"

namespace fleetproof {
namespace {

// The search ends with the part in which a run refutes: enough for all workers, and few enough to be worth ending.
constexpr std::size_t kTrialsAtOnce = 64;

using TakeOut = std::function<void(Scenario&)>;

// Whether a run fails as the finding does.
class SameWay {
 public:
  SameWay(const Mechanism& mechanism, const FailureNeeds& representative)
      : end_(mechanism.end), doing_(mechanism.doing) {
    for (const std::string& word : representative.said) {
      const std::string trait = trait_of_word(word);
      if (names_all(mechanism.words, {trait}) || names_all(mechanism.traits, {trait})) words_.push_back(word);
    }
  }

  bool matches(const CaseRun& run) const {
    const auto failure = failure_of(run);
    return failure && end_of(*failure) == end_ && names_all(run.words, words_) &&
           (doing_.empty() || names_all(doings_of(run), {doing_}));
  }

 private:
  std::string end_, doing_;
  std::vector<std::string> words_;
};

// None: nothing of the kind can be taken out of a run of this finding.
std::optional<TakeOut> taking_out(const std::string& need, const FailureNeeds& representative) {
  if (need == kThirdAgvTrait) {
    const Failure& failure = representative.reduced.failure;
    if (!failure.a.valid() || !failure.b.valid()) return std::nullopt;
    const Scenario& reduced = representative.reduced.scenario;
    const auto is_agv = [&](EntityId body) { return body.index() < reduced.agvs.size(); };
    if (!is_agv(failure.a) || !is_agv(failure.b)) return std::nullopt;
    const std::vector<std::string> pair{reduced.agvs[failure.a.index()].name, reduced.agvs[failure.b.index()].name};
    return [pair](Scenario& scenario) {
      scenario = with_agvs(scenario, [&](std::size_t agv) { return names_all(pair, {scenario.agvs[agv].name}); });
    };
  }
  std::vector<std::string> kinds;
  constexpr std::string_view kOfMessages = " messages";
  if (need.ends_with(kOfMessages)) kinds.push_back(need.substr(0, need.size() - kOfMessages.size()));
  for (const Ingredient& ingredient : ingredients_of(representative.reduced.scenario, kinds)) {
    if (ingredient.name == need) return ingredient.take_out;
  }
  return std::nullopt;
}

bool fails_without(CaseHost& host, const SameWay& same_way, const TakeOut& take_out, const RefutationSearch& search,
                   const Scenario& reduced) {
  const auto without = [&](Scenario scenario) {
    take_out(scenario);
    return is_fair(scenario) ? std::optional(std::move(scenario)) : std::nullopt;
  };
  const auto any_fails = [&](const Candidates& candidates) {
    const auto runs = all_runs(host, candidates);
    return std::ranges::any_of(runs, [&](const auto& run) { return run && same_way.matches(*run); });
  };
  if (any_fails({search.smaller.size(), [&](std::size_t i) { return without(search.smaller[i]); }})) return true;
  for (std::uint64_t from = 0; from < search.trials; from += kTrialsAtOnce) {
    const auto count = std::min<std::uint64_t>(kTrialsAtOnce, search.trials - from);
    const bool fails = any_fails({count, [&](std::size_t i) {
                                    const std::uint64_t trial = from + i;
                                    const auto draw = static_cast<std::uint32_t>(trial / 2 + 1);
                                    const Scenario& base = trial % 2 == 0 ? reduced : search.run;
                                    auto less = without(base);
                                    return less ? std::optional(with_other_timeline(*less, draw, kLatest)) : less;
                                  }});
    if (fails) return true;
  }
  return false;
}

}  // namespace

void add_refuted_needs(CaseHost& host, const Finding& finding, std::span<const KnownFailure> failures,
                       const RefutationSearch& search, std::vector<std::string>& found) {
  const KnownFailure& representative = failures[finding.representative];
  if (representative.needs.is_rare) return;  // what it needs is not known
  const Mechanism& mechanism = finding.mechanism;
  const SameWay same_way(mechanism, representative.needs);
  std::vector<std::string> needs = mechanism.needs;
  if (names_all(mechanism.traits, {kThirdAgvTrait})) needs.emplace_back(kThirdAgvTrait);
  for (const std::string& need : needs) {
    if (names_all(found, {need})) continue;
    const auto does_without = [&](std::size_t member) {
      const FailureNeeds& its = failures[member].needs;
      return !its.is_rare && !names_all(its.needs, {need});
    };
    if (need != kThirdAgvTrait && std::ranges::any_of(finding.members, does_without)) {
      found.push_back(need);
      continue;
    }
    const auto take_out = taking_out(need, representative.needs);
    if (take_out && fails_without(host, same_way, *take_out, search, representative.needs.reduced.scenario))
      found.push_back(need);
  }
}

}  // namespace fleetproof
