#include "campaign/findings/refuted_needs.hpp"

#include <algorithm>
#include <functional>
#include <optional>

#include "campaign/findings/ingredients.hpp"
#include "campaign/shrink/all_runs.hpp"
#include "campaign/shrink/fitness.hpp"
#include "campaign/shrink/other_draws.hpp"
#include "campaign/shrink/shrink.hpp"
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

// What a trial begins with, and what is taken out of it.
struct TrialBase {
  Scenario scenario;
  TakeOut take_out;
};

// The reduced and the whole run of a member, and the reduced run of its two AGVs alone.
void add_bases(const std::string& need, const FailureNeeds& member, const Scenario* run,
               std::vector<TrialBase>& bases) {
  const auto take_out = taking_out(need, member);
  if (!take_out) return;
  bases.push_back({member.reduced.scenario, *take_out});
  if (run != nullptr) bases.push_back({*run, *take_out});
  if (const auto others = taking_out(kThirdAgvTrait, member); others && need != kThirdAgvTrait) {
    bases.push_back({member.reduced.scenario, *take_out});
    (*others)(bases.back().scenario);
  }
}

// Fails again with what is taken out, in one of the trials.
class RunsWithout {
 public:
  RunsWithout(const std::string& need, const Finding& finding, std::span<const KnownFailure> failures,
              const RefutationSearch& search) {
    for (std::size_t i = 0; i < finding.members.size(); ++i) {
      const FailureNeeds& needs = failures[finding.members[i]].needs;
      const bool is_simplest = finding.members[i] == finding.representative;
      if (needs.is_rare || (!is_simplest && others_.size() >= kMostOthers)) continue;
      add_bases(need, needs, i < search.runs.size() ? &search.runs[i] : nullptr, is_simplest ? simplest_ : others_);
    }
  }

  bool empty() const { return simplest_.empty(); }
  // With another timeline each time. None: what is left is no fair scenario.
  std::optional<Scenario> trial(std::uint64_t number) const {
    const bool is_other = number % 2 == 1 && !others_.empty();
    const std::vector<TrialBase>& bases = is_other ? others_ : simplest_;
    const std::uint64_t turn = others_.empty() ? number : number / 2;
    const TrialBase& base = bases[turn % bases.size()];
    Scenario scenario = base.scenario;
    base.take_out(scenario);
    if (!is_fair(scenario)) return std::nullopt;
    return with_other_timeline(scenario, static_cast<std::uint32_t>(turn / bases.size() + 1), kLatest);
  }
  // A case without it, as it is.
  std::optional<Scenario> without(Scenario scenario) const {
    simplest_.front().take_out(scenario);
    return is_fair(scenario) ? std::optional(std::move(scenario)) : std::nullopt;
  }

 private:
  static constexpr std::size_t kMostOthers = 40;  // more would get too few trials each

  std::vector<TrialBase> simplest_, others_;
};

bool fails_without(CaseHost& host, const SameWay& same_way, const RunsWithout& trials, const RefutationSearch& search) {
  const auto any_fails = [&](const Candidates& candidates) {
    const auto runs = all_runs(host, candidates);
    return std::ranges::any_of(runs, [&](const auto& run) { return run && same_way.matches(*run); });
  };
  if (any_fails({search.smaller.size(), [&](std::size_t i) { return trials.without(search.smaller[i]); }})) return true;
  for (std::uint64_t from = 0; from < search.trials; from += kTrialsAtOnce) {
    const auto count = std::min<std::uint64_t>(kTrialsAtOnce, search.trials - from);
    if (any_fails({count, [&](std::size_t i) { return trials.trial(from + i); }})) return true;
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
    const RunsWithout trials(need, finding, failures, search);
    if (!trials.empty() && fails_without(host, same_way, trials, search)) found.push_back(need);
  }
}

std::vector<Scenario> shrunk(CaseHost& host, std::span<const Scenario> runs, std::uint64_t trials) {
  std::vector<Scenario> smallest;
  for (const Scenario& run : runs) {
    const CaseRun as_it_was = host(run);
    const auto failure = failure_of(as_it_was);
    if (!failure) continue;
    const FailingCase failing{run, *failure, as_it_was.outcome.digest};
    TrialCache cache;
    smallest.push_back(
        shrink(host, cache, failing, pattern_of(host, failing), {trials}, [](const FailingCase&, std::string_view) {
        }).best.scenario);
  }
  return smallest;
}

}  // namespace fleetproof
