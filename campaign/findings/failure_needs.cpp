#include "campaign/findings/failure_needs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <set>
#include <utility>

#include "campaign/findings/ingredients.hpp"
#include "campaign/findings/word_comparison.hpp"
#include "campaign/shrink/adverse_deliveries.hpp"
#include "campaign/shrink/fitness.hpp"
#include "campaign/shrink/other_draws.hpp"
#include "campaign/shrink/surgery.hpp"

namespace fleetproof {
namespace {

constexpr std::uint32_t kEnoughTries = 4, kFewestTries = 8, kMostTries = 24;
// A run that seldom fails with other draws may need nothing but that two AGVs meet in some way. That is looked for
// first.
constexpr std::size_t kFewDraws = 2;
constexpr std::uint32_t kTriesForNothing = 40;
// With more of them, what seems needed was tried often enough.
constexpr std::size_t kManyDraws = 4;
constexpr std::size_t kMostKinds = 16;  // of messages; with more, no replay would be left for the other ingredients

// What keeps a fleet from its work is told apart by who waits for whom, which is chance.
bool is_no_progress(std::string_view what) {
  if (what == name_of(OutcomeClass::Stuck)) return true;
  return std::ranges::any_of(incident_kinds(), [&](const IncidentKindInfo& info) {
    return info.name == what && info.end_point && info_of(*info.end_point).is_lack_of_progress;
  });
}

// Those of which most messages were lost or late. An agent may give each message a kind of its own.
std::vector<std::string> adverse_kinds(const std::vector<MessageDelivery>& deliveries) {
  std::map<std::string, std::size_t> counts;
  for (const MessageDelivery& message : deliveries) {
    if (message.is_adverse() && !message.kind.empty()) ++counts[message.kind];
  }
  std::vector<std::string> kinds;
  for (const auto& [kind, count] : counts) kinds.push_back(kind);
  if (kinds.size() <= kMostKinds) return kinds;
  std::ranges::stable_sort(kinds, std::greater{}, [&](const std::string& kind) { return counts.at(kind); });
  kinds.resize(kMostKinds);
  std::ranges::sort(kinds);
  return kinds;
}

std::string trait_of_doing(const std::string& doing) {
  if (doing == kTurning) return "one turns";
  if (doing == kOnABend) return "one is on a bend";
  if (doing == kBackward) return "one drives backward";
  if (doing == kTransferring) return "one moves a load";
  return "";
}

// Takes things out of one failing scenario.
class Reduction {
 public:
  Reduction(CaseHost& host, const Scenario& scenario) : host_(host), original_(scenario) {}

  std::optional<FailureNeeds> find(const RunFailure* stored) {
    const CaseRun run = simulate(original_, Deliveries::Kept);
    const auto failure = failure_of(run);
    const auto chosen = chosen_failure(run.outcome, run.choice);
    if (!failure || (stored != nullptr && !is_same_failure(*chosen, *stored))) return std::nullopt;
    likeness_.end = end_of(*failure);
    best_ = {original_, *failure, run.outcome.digest};
    learn_words(run);
    found_.end = likeness_.end;
    const auto ingredients = ingredients_of(original_, adverse_kinds(run.deliveries));
    take_out_ingredients(ingredients);
    if (failing_draws_.size() <= kManyDraws) try_again(ingredients);
    add_traits();
    found_.reduced = std::move(best_);
    found_.is_rare = !failed_otherwise_ && failing_draws_.empty();
    found_.failing_draws = static_cast<std::uint32_t>(failing_draws_.size());
    found_.replays = replays_;
    return std::move(found_);
  }

 private:
  static Scenario another(const Scenario& scenario, std::uint32_t draw) {
    return with_other_timeline(scenario, draw, kLatest);
  }
  CaseRun simulate(const Scenario& scenario, Deliveries deliveries = Deliveries::Ignored) {
    ++replays_;
    return host_(scenario, deliveries);
  }

  // What its agents say when it ends so, and the draws with which it does.
  void learn_words(const CaseRun& run) {
    learner_.emplace(run);
    const CaseRun undisturbed = simulate(with_deliveries_only(original_, {}));
    if (!failure_of(undisturbed)) learner_->hear_undisturbed(undisturbed);
    std::vector<CaseRun> others;
    for (std::uint32_t draw = 1; draw <= kOtherRuns; ++draw) {
      others.push_back(simulate(another(original_, draw)));
      if (!failure_of(others.back())) learner_->hear_passing(others.back());
    }
    likeness_.words = {{}, learner_->pattern().usual};
    WordComparison comparison(best_.failure);
    for (std::uint32_t draw = 1; draw <= kOtherRuns; ++draw) {
      const CaseRun& other = others[draw - 1];
      if (!failure_of(other)) comparison.add_passing(other);
      if (!likeness_.match(other)) continue;
      failing_draws_.push_back(draw);
      learner_->hear_failing(other);
      comparison.add_failing();
    }
    learner_->keep_telling([&](const std::string& word) { return comparison.is_telling(word); });
    likeness_.words.telling = telling_words();
  }
  std::vector<std::string> telling_words() const {
    if (learner_->passing() < kEnoughTries) return {};
    return learner_->pattern().telling;
  }

  void take_out_ingredients(const std::vector<Ingredient>& ingredients) {
    const bool seldom = failing_draws_.size() < kFewDraws;
    const bool needs_nothing = seldom && fails_after(all_of(ingredients), kTriesForNothing);
    const auto tries =
        std::clamp(replays_left() / static_cast<std::uint32_t>(ingredients.size() + 1), kFewestTries, kMostTries);
    for (const Ingredient& ingredient : ingredients) {
      if (!needs_nothing && !fails_after(ingredient.take_out, tries)) found_.needs.push_back(ingredient.name);
    }
    if (!is_pair() || best_.scenario.agvs.size() == 2) return;
    const auto [a, b] = std::pair(best_.failure.a.index(), best_.failure.b.index());
    const auto leave_the_two = [a = a, b = b](Scenario& s) {
      s = with_agvs(s, [a, b](std::size_t agv) { return agv == a || agv == b; });
    };
    needs_third_ = !fails_after(leave_the_two, tries);
  }

  // A failure that seldom comes about may have been missed: what seems needed is tried with the replays that are left.
  void try_again(const std::vector<Ingredient>& ingredients) {
    for (const Ingredient& ingredient : ingredients) {
      const auto place = std::ranges::find(found_.needs, ingredient.name);
      if (place == found_.needs.end()) continue;
      const std::uint32_t left = replays_left();
      if (left == 0) return;
      const auto tries = left / static_cast<std::uint32_t>(found_.needs.end() - place);
      if (fails_with_new_draws(ingredient.take_out, tries)) found_.needs.erase(place);
    }
  }

  // One run is kept for the end, and one to spare.
  std::uint32_t replays_left() const {
    return static_cast<std::uint32_t>(kReplaysPerFailure - 2 - std::min(replays_, kReplaysPerFailure - 2));
  }

  static std::function<void(Scenario&)> all_of(const std::vector<Ingredient>& ingredients) {
    return [&](Scenario& scenario) {
      for (const Ingredient& ingredient : ingredients) ingredient.take_out(scenario);
    };
  }

  bool is_pair() const {
    const auto is_agv = [&](EntityId body) { return body.valid() && body.index() < best_.scenario.agvs.size(); };
    return is_agv(best_.failure.a) && is_agv(best_.failure.b);
  }

  // With the draws that it has now, with those with which the whole scenario failed, and with others.
  bool fails_after(const std::function<void(Scenario&)>& edit, std::uint32_t tries) {
    Scenario less = best_.scenario;
    edit(less);
    if (!is_fair(less)) return false;
    if (fails(less)) return true;
    std::vector<std::uint32_t> draws = failing_draws_;
    for (std::uint32_t draw = kOtherRuns + 1; draws.size() < tries; ++draw) draws.push_back(draw);
    draws.resize(tries - 1);
    const bool failed = std::ranges::any_of(draws, [&](std::uint32_t draw) { return fails(another(less, draw)); });
    failed_otherwise_ |= failed;
    return failed;
  }
  // With draws that no other step has tried.
  bool fails_with_new_draws(const std::function<void(Scenario&)>& edit, std::uint32_t tries) {
    Scenario less = best_.scenario;
    edit(less);
    if (!is_fair(less)) return false;
    bool failed = false;
    for (std::uint32_t i = 0; i < tries && !failed; ++i) failed = fails(another(less, next_new_draw_++));
    failed_otherwise_ |= failed;
    return failed;
  }
  // Keeps the scenario if it does.
  bool fails(Scenario scenario) {
    if (replays_ >= kReplaysPerFailure - 1) return false;
    const CaseRun run = simulate(scenario);
    auto failure = likeness_.match(run);
    if (failure) best_ = {std::move(scenario), *failure, run.outcome.digest};
    if (!failure_of(run)) learner_->hear_passing(run);
    return failure.has_value();
  }

  void add_traits() {
    std::set<std::string> traits;
    const CaseRun reduced = simulate(best_.scenario);
    found_.doings = doings_of(reduced);
    for (const std::string& word : telling_words()) {
      if (std::ranges::binary_search(reduced.words, word)) traits.insert(trait_of_word(word));
    }
    if (needs_third_) traits.insert(kThirdAgvTrait);
    found_.traits.assign(traits.begin(), traits.end());
    found_.said = reduced.words;
  }

  CaseHost& host_;
  const Scenario& original_;
  FailureLikeness likeness_;
  FailingCase best_;
  FailureNeeds found_;
  std::vector<std::uint32_t> failing_draws_;
  std::optional<WordLearner> learner_;
  std::uint64_t replays_ = 0;
  std::uint32_t next_new_draw_ = kOtherRuns + kTriesForNothing + 1;
  bool needs_third_ = false, failed_otherwise_ = false;
};

}  // namespace

std::string trait_of_word(const std::string& word) { return fmt::format("says \"{}\"", word); }

std::string end_of(const Failure& failure) {
  const auto comma = failure.kind.what.find(',');
  const std::string what = failure.kind.what.substr(0, comma);
  if (is_no_progress(what)) return "no progress";
  if (!failure.is_violation) return failure.kind.what;
  return "too close" + (comma == std::string::npos ? "" : failure.kind.what.substr(comma));
}

std::vector<std::string> doings_of(const CaseRun& run) {
  std::set<std::string> doings;
  for (const std::string& doing : run.doing) {
    if (std::string trait = trait_of_doing(doing); !trait.empty()) doings.insert(std::move(trait));
  }
  return {doings.begin(), doings.end()};
}

std::optional<Failure> FailureLikeness::match(const CaseRun& run) const {
  auto failure = failure_of(run);
  if (!failure || end_of(*failure) != end || !words.match(run.words)) return std::nullopt;
  return failure;
}

std::optional<FailureNeeds> needs_of(CaseHost& host, const Scenario& scenario, const RunFailure* stored) {
  return Reduction(host, scenario).find(stored);
}

}  // namespace fleetproof
