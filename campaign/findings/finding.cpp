#include "campaign/findings/finding.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <tuple>
#include <utility>

#include "campaign/findings/home.hpp"
#include "campaign/findings/ingredients.hpp"
#include "campaign/findings/naming_words.hpp"
#include "campaign/findings/word_comparison.hpp"
#include "core/base/random.hpp"
#include "reports/evidence/binomial.hpp"

namespace fleetproof {
namespace {

using Needs = std::vector<std::string>;
using Members = std::vector<std::size_t>;

// Shares of failures: with a trait that is part of the mechanism, and of drives without anything special that leave
// open what the bodies have to do.
constexpr std::size_t kCommonPercent = 90, kDrivenOnPercent = 10;
// Where they did several things, it is to be 95 % sure that so few just drove on: of few failures, all may by chance
// have done something.
constexpr double kFewDroveOn = 0.2;
// One failure in four may have come about in another way than the others.
constexpr std::size_t kMostPercent = 75;

// Two in three failures that need a kind of messages tell that it is no chance.
constexpr std::size_t kKindShare = 2, kKindOf = 3;

// Below this, a set of needs may be an accident of the draws with which it was looked for.
constexpr std::size_t kFewMembers = 3, kRareShare = 20;
// Of the failures that need something, so many have to need nothing else, or the others have another cause. Few
// failures do not tell.
constexpr double kRuleShare = 0.3;
constexpr std::uint32_t kSomeDraws = 4;
// Fewer failures that say the same have too few sets of needs for one of them to be frequent.
constexpr std::size_t kEnoughToCount = 10;

// A word tells few failures apart by itself where passing runs often say it, too. It is that of them all if it tells
// more of them than chance would let it.
std::vector<std::string> common_traits(std::span<const KnownFailure> failures, const Members& members) {
  std::map<std::string, std::size_t> having;
  for (const std::size_t member : members) {
    for (const std::string& trait : failures[member].needs.traits) ++having[trait];
  }
  std::vector<std::string> common;
  for (const auto& [trait, count] : having) {
    const auto said = static_cast<std::size_t>(std::ranges::count_if(
        members, [&, &word = trait](std::size_t member) { return says(failures[member].needs, word); }));
    const bool is_chance = lower_bound(count, members.size(), Confidence{0.95}) <= kRareChance;
    if (100 * (is_chance ? count : said) >= kCommonPercent * members.size()) common.push_back(trait);
  }
  return common;
}

// What nine in ten of them did; empty if there is no such thing.
std::string common_doing(std::span<const KnownFailure> failures, const Members& members) {
  std::map<std::string, std::size_t> counts;
  for (const std::size_t member : members) {
    for (const std::string& doing : failures[member].needs.doings) ++counts[doing];
  }
  const auto most = std::ranges::max_element(counts, {}, [](const auto& count) { return count.second; });
  return most != counts.end() && 100 * most->second >= kCommonPercent * members.size() ? most->first : "";
}

// Whether what the bodies did tells these failures apart.
bool tells_apart(std::span<const KnownFailure> failures, const Members& members) {
  const auto drove_on = static_cast<std::size_t>(
      std::ranges::count_if(members, [&](std::size_t member) { return failures[member].needs.doings.empty(); }));
  if (100 * drove_on >= kDrivenOnPercent * members.size()) return false;
  return !common_doing(failures, members).empty() ||
         upper_bound(drove_on, members.size(), Confidence{0.95}) < kFewDroveOn;
}

// Failures with the same needs, by what the bodies did.
std::map<std::string, Members> parted(std::span<const KnownFailure> failures, Members members) {
  if (!tells_apart(failures, members)) return {{"", std::move(members)}};
  std::map<std::string, Members> parts;
  while (!members.empty()) {
    std::map<std::string, std::size_t> counts;
    for (const std::size_t member : members) {
      for (const std::string& doing : failures[member].needs.doings) ++counts[doing];
    }
    // What all the others did may have been chance in the few that drove on.
    if (counts.empty()) {
      Members& most = std::ranges::max_element(parts, {}, [](const auto& part) { return part.second.size(); })->second;
      most.insert(most.end(), members.begin(), members.end());
      break;
    }
    const std::string doing = std::ranges::max_element(counts, {}, [](const auto& c) { return c.second; })->first;
    const auto did = [&](std::size_t member) { return names_all(failures[member].needs.doings, {doing}); };
    std::ranges::copy_if(members, std::back_inserter(parts[doing]), did);
    std::erase_if(members, did);
  }
  return parts;
}

bool is_sure(const FailureNeeds& failure) { return !failure.is_rare; }

// What each failure needs, without the kinds of messages that are chance: most failures that need the same beside them
// do without these. A kind that most of them need, the others need, too.
std::map<Needs, Members> by_needs(std::span<const KnownFailure> failures, const Members& members) {
  std::map<Needs, Members> alike, found;
  for (const std::size_t member : members) alike[without_kinds(failures[member].needs.needs)].push_back(member);
  for (const auto& [rest, those] : alike) {
    std::map<std::string, std::size_t> counts;
    std::size_t sure = 0;
    for (const std::size_t member : those) {
      if (failures[member].needs.is_rare) continue;
      ++sure;
      for (const std::string& need : failures[member].needs.needs) ++counts[need];
    }
    Needs needs = rest;
    for (const auto& [need, count] : counts) {
      if (!names_all(rest, {need}) && kKindOf * count >= kKindShare * sure) needs.push_back(need);
    }
    Members& all = found[needs];
    all.insert(all.end(), those.begin(), those.end());
  }
  return found;
}

// Puts failures of one agent with one end together: those with the same needs whose bodies did the same.
class Gathering {
 public:
  using Key = std::pair<Needs, std::string>;

  Gathering(std::span<const KnownFailure> failures, const Members& members)
      : failures_(failures), by_needs_(by_needs(failures, members)), count_(members.size()) {}

  std::map<Key, Members> gathered() const {
    const std::vector<Home> all = homes();
    std::map<Key, Members> gathered;
    for (const auto& [needs, members] : by_needs_) {
      Members others, rare;
      for (const std::size_t member : members) {
        const Home* home = home_of(failures_[member].needs, needs, all);
        if (home == nullptr && members.size() < kFewMembers) home = related_home(failures_[member].needs, all);
        if (home != nullptr) {
          gathered[{home->needs, home->doing}].push_back(member);
        } else {
          (failures_[member].needs.is_rare ? rare : others).push_back(member);
        }
      }
      for (auto& [doing, part] : parted(failures_, std::move(others))) {
        if (!part.empty()) std::ranges::copy(part, std::back_inserter(gathered[{needs, doing}]));
      }
      if (!rare.empty()) std::ranges::copy(rare, std::back_inserter(gathered[{{kNotKnown}, ""}]));
    }
    for (auto& [key, members] : gathered) std::ranges::sort(members);
    return gathered;
  }

 private:
  // Frequent mechanisms, the simplest first.
  std::vector<Home> homes() const {
    std::vector<Home> homes;
    for (const auto& [needs, members] : by_needs_) {
      for (auto [doing, part] : parted(failures_, members)) {
        std::erase_if(part, [&](std::size_t member) { return failures_[member].needs.is_rare; });
        if (part.size() < kFewMembers || kRareShare * part.size() < count_) continue;
        homes.push_back({needs, doing, common_traits(failures_, part), part.size(), false, is_rule(needs)});
        std::erase(homes.back().words, kThirdAgvTrait);  // who fails without a third AGV fails in the same way
      }
    }
    add_cores_of_words(homes);
    add_core_of_few(homes);
    std::ranges::stable_sort(homes, {}, [](const Home& home) { return std::pair(home.needs.size(), ~home.size); });
    add_cores(homes);
    return homes;
  }

  // Whether so many need just this that those that need more may need the rest by chance. Where an agent has many
  // faults, those of one of them, which needs little, are few beside all the others.
  bool is_rule(const Needs& needs) const {
    std::size_t all = 0, just_this = 0;
    for (const auto& [needed, members] : by_needs_) {
      if (!names_all(needed, needs)) continue;
      all += members.size();
      if (needed == needs) just_this += members.size();
    }
    return upper_bound(just_this, all, Confidence{0.95}) >= kRuleShare;
  }

  // Most failures of the agent say the same telling word, and they are few, or no set of needs is that of most: what
  // most of them need. Otherwise the frequent needs say more: a failure may come about in one of several ways.
  void add_cores_of_words(std::vector<Home>& homes) const {
    std::map<std::string, Members> saying;
    for (const auto& [needs, members] : by_needs_) {
      for (const std::size_t member : members) {
        for (const std::string& trait : failures_[member].needs.traits) {
          if (trait != kThirdAgvTrait && is_sure(failures_[member].needs)) saying[trait].push_back(member);
        }
      }
    }
    for (const auto& [word, members] : saying) {
      const bool is_rule = 2 * members.size() >= count_;
      if (!is_rule || (members.size() >= kEnoughToCount && have_a_rule(members))) continue;
      const Needs most = needed_by_most(members);
      const Needs core = members.size() < kFewMembers ? without_kinds(most) : most;  // two do not tell what is chance
      const auto needs_no_more = [&](std::size_t member) { return failures_[member].needs.needs == core; };
      if (core.empty() && std::ranges::none_of(members, needs_no_more)) continue;
      for (const auto& [doing, part] : parted(failures_, members)) {
        if (!part.empty()) homes.push_back({core, doing, {word}, part.size(), true, true});
      }
    }
  }

  // An agent with few failures, in all of which the bodies did the same: if one of them needs no more than all do, the
  // others do without the rest.
  void add_core_of_few(std::vector<Home>& homes) const {
    Members sure;
    for (const auto& [needs, members] : by_needs_)
      std::ranges::copy_if(members, std::back_inserter(sure),
                           [&](std::size_t i) { return is_sure(failures_[i].needs); });
    if (sure.empty() || sure.size() >= kEnoughToCount) return;
    const std::string doing = common_doing(failures_, sure);
    const Needs core = in_common(sure);
    const auto needs_no_more = [&](std::size_t member) { return failures_[member].needs.needs == core; };
    if (!doing.empty() && std::ranges::any_of(sure, needs_no_more))
      homes.push_back({core, doing, {}, sure.size(), false, true});
  }

  // Whether half of them need the same.
  bool have_a_rule(const Members& members) const {
    std::map<Needs, std::size_t> counts;
    for (const std::size_t member : members) ++counts[failures_[member].needs.needs];
    return 2 * std::ranges::max_element(counts, {}, [](const auto& count) { return count.second; })->second >=
           members.size();
  }

  Needs needed_by_most(const Members& members) const {
    std::map<std::string, std::size_t> counts;
    for (const std::size_t member : members) {
      for (const std::string& need : failures_[member].needs.needs) ++counts[need];
    }
    std::erase_if(counts, [&](const auto& count) { return 100 * count.second < kMostPercent * members.size(); });
    // In the order of the failure that names most of them.
    const auto named = [&](std::size_t member) {
      Needs needs = failures_[member].needs.needs;
      std::erase_if(needs, [&](const std::string& need) { return !counts.contains(need); });
      return needs;
    };
    Needs core =
        named(*std::ranges::max_element(members, {}, [&](std::size_t member) { return named(member).size(); }));
    for (const auto& [need, count] : counts) {
      if (!names_all(core, {need})) core.push_back(need);
    }
    return core;
  }

  // What all of them need.
  Needs in_common(const Members& members) const {
    Needs core = failures_[members.front()].needs.needs;
    for (const std::size_t member : members)
      std::erase_if(core, [&](const std::string& need) { return !names_all(failures_[member].needs.needs, {need}); });
    return core;
  }

  // Of failures that no home takes, each with needs of its own: what several of them have in common.
  void add_cores(std::vector<Home>& homes) const {
    Members left;
    for (const auto& [needs, members] : by_needs_) {
      for (const std::size_t member : members) {
        const FailureNeeds& failure = failures_[member].needs;
        const bool is_taken = std::ranges::any_of(homes, [&](const Home& home) { return home.takes(failure, needs); });
        if (!is_taken && !failure.is_rare) left.push_back(member);
      }
    }
    for (;;) {
      std::map<std::string, std::size_t> counts;
      for (const std::size_t member : left) {
        for (const std::string& need : failures_[member].needs.needs) ++counts[need];
      }
      const auto most = std::ranges::max_element(counts, {}, [](const auto& count) { return count.second; });
      if (most == counts.end() || most->second < kFewMembers) return;
      const std::string common = most->first;
      const auto has_it = [&](std::size_t member) { return names_all(failures_[member].needs.needs, {common}); };
      Members sharing;
      std::ranges::copy_if(left, std::back_inserter(sharing), has_it);
      homes.push_back({in_common(sharing), "", {}, most->second, false, true, true});
      std::erase_if(left, has_it);
    }
  }

  std::span<const KnownFailure> failures_;
  std::map<Needs, Members> by_needs_;
  std::size_t count_ = 0;
};

// Of those that need no more than the mechanism does: few AGVs, no rare draw, an early failure.
std::size_t simplest(std::span<const KnownFailure> failures, const Members& members, const Needs& needs) {
  const auto effort = [&](std::size_t member) {
    const FailureNeeds& failure = failures[member].needs;
    return std::tuple(failure.needs != needs, failure.reduced.scenario.agvs.size(), failure.failing_draws < kSomeDraws,
                      failure.reduced.failure.at, failures[member].run);
  };
  return *std::ranges::min_element(members, {}, effort);
}

// A naming word is part of the name only where another finding would have the same. Of few failures, it is not known.
void drop_needless_words(std::vector<Finding>& findings) {
  const auto name_of = [](const Finding& finding) {
    const Mechanism& is = finding.mechanism;
    return std::tuple(finding.agent, is.end, is.needs, is.doing);
  };
  std::map<decltype(name_of(findings.front())), std::size_t> times;
  for (const Finding& finding : findings) ++times[name_of(finding)];
  for (Finding& finding : findings) {
    if (times[name_of(finding)] > 1) continue;
    std::vector<std::string> traits;
    std::ranges::set_union(finding.mechanism.traits, finding.mechanism.words, std::back_inserter(traits));
    finding.mechanism.traits = std::move(traits);
    finding.mechanism.words.clear();
  }
}

}  // namespace

std::string Mechanism::text() const {
  std::string text = end;
  text += needs.empty() ? "; needs nothing" : fmt::format("; needs {}", fmt::join(needs, ", "));
  if (!doing.empty()) text += "; " + doing;
  for (const std::string& word : words) text += "; " + word;
  for (const std::string& trait : traits) {
    if (!names_all(words, {trait})) text += "; " + trait;
  }
  return text;
}

std::string Finding::text() const {
  Mechanism shown = mechanism;
  const bool is_single = members.size() == 1;
  if (!is_single && is_searched) return without_refuted(shown.text(), refuted);
  std::erase(shown.traits, kThirdAgvTrait);
  if (std::exchange(shown.needs, {}).empty()) return without_refuted(shown.text(), refuted);
  std::string text = shown.text();
  const std::string nothing = "; needs nothing";
  return text.replace(text.find(nothing), nothing.size(),
                      is_single ? "; one failure does not tell what it needs"
                                : "; whether it needs what these failures needed is not known");
}

namespace {

std::vector<std::string> split(std::string_view text, std::string_view between) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(between, begin), text.size());
    parts.emplace_back(text.substr(begin, end - begin));
    begin = end + between.size();
  }
  return parts;
}

}  // namespace

std::string without_refuted(const std::string& mechanism, const std::vector<std::string>& refuted) {
  if (refuted.empty()) return mechanism;
  constexpr std::string_view kNeeds = "needs ", kFailsWithout = " (fails without ";
  const auto is_refuted = [&](const std::string& need) { return names_all(refuted, {need}); };
  std::vector<std::string> parts = split(mechanism.substr(0, mechanism.rfind(kFailsWithout)), "; ");
  std::erase_if(parts, [&](const std::string& part) { return part == kThirdAgvTrait && is_refuted(part); });
  for (std::string& part : parts) {
    if (!part.starts_with(kNeeds) || part == kThirdAgvTrait) continue;
    std::vector<std::string> needs = split(part.substr(kNeeds.size()), ", ");
    std::erase_if(needs, is_refuted);
    part = needs.empty() ? "needs nothing" : fmt::format("needs {}", fmt::join(needs, ", "));
  }
  std::vector<std::string> names;
  for (const std::string& need : refuted) names.push_back(need == kThirdAgvTrait ? "a third AGV" : need);
  return fmt::format("{}{}{}, too)", fmt::join(parts, "; "), kFailsWithout, fmt::join(names, ", "));
}

bool Finding::has_no_needs() const {
  const bool third = names_all(mechanism.traits, {kThirdAgvTrait}) && !names_all(refuted, {kThirdAgvTrait});
  return !third && names_all(refuted, mechanism.needs);
}

std::string Finding::id() const {
  const Mechanism named{mechanism.end, mechanism.needs, mechanism.doing, mechanism.words, {}};
  return fmt::format("F-{:08x}", name_hash(agent + ": " + named.text()) >> 32);
}

std::vector<Finding> findings_of(std::span<const KnownFailure> failures) {
  std::map<std::pair<std::string, std::string>, Members> alike;
  for (std::size_t i = 0; i < failures.size(); ++i) alike[{failures[i].agent, failures[i].needs.end}].push_back(i);
  std::vector<Finding> findings;
  for (const auto& [of, all] : alike) {
    for (const auto& [words, members] : by_naming_words(failures, all)) {
      for (const auto& [key, those] : Gathering(failures, members).gathered()) {
        const auto& [needs, doing] = key;
        Finding finding;
        finding.agent = of.first;
        finding.mechanism = {of.second, needs, doing, words, common_traits(failures, those)};
        finding.members = those;
        finding.representative = simplest(failures, those, needs);
        findings.push_back(std::move(finding));
      }
    }
  }
  drop_needless_words(findings);
  std::ranges::stable_sort(findings, std::ranges::greater(), [](const Finding& f) { return f.members.size(); });
  return findings;
}

}  // namespace fleetproof
