#include "campaign/findings/finding.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <tuple>
#include <utility>

#include "campaign/findings/ingredients.hpp"
#include "core/base/random.hpp"

namespace fleetproof {
namespace {

using Needs = std::vector<std::string>;
using Members = std::vector<std::size_t>;

// Shares of failures: with a trait that is part of the mechanism, and of drives without anything special that leave
// open what the bodies have to do.
constexpr std::size_t kCommonPercent = 90, kDrivenOnPercent = 10;

// Below this, a set of needs may be an accident of the luck with which it was looked for.
constexpr std::size_t kFewMembers = 3, kRareShare = 20;
constexpr std::uint32_t kSomeLucks = 4;
// Fewer failures that say the same have too few sets of needs for one of them to be frequent.
constexpr std::size_t kEnoughToCount = 10;

std::vector<std::string> common_traits(std::span<const KnownFailure> failures, const Members& members) {
  std::map<std::string, std::size_t> having;
  for (const std::size_t member : members) {
    for (const std::string& trait : failures[member].needs.traits) ++having[trait];
  }
  std::vector<std::string> common;
  for (const auto& [trait, count] : having) {
    if (100 * count >= kCommonPercent * members.size()) common.push_back(trait);
  }
  return common;
}

// Failures with the same needs, by what the bodies did.
std::map<std::string, Members> parted(std::span<const KnownFailure> failures, Members members) {
  const auto drove_on =
      std::ranges::count_if(members, [&](std::size_t member) { return failures[member].needs.doings.empty(); });
  if (100 * static_cast<std::size_t>(drove_on) >= kDrivenOnPercent * members.size()) return {{"", std::move(members)}};
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

// Whether its agents had said what the trait names, though it may be too seldom compared to tell.
bool says(const FailureNeeds& failure, const std::string& trait) {
  return std::ranges::any_of(failure.said, [&](const std::string& word) { return trait == trait_of_word(word); });
}

struct Home {
  Needs needs;
  std::string doing;
  std::vector<std::string> words;
  std::size_t size = 0;

  // Who just drove on where nearly all others did something may have done so a little later.
  bool takes(const FailureNeeds& failure) const {
    const bool did_so =
        doing.empty() || names_all(failure.doings, {doing}) || (failure.doings.empty() && failure.needs == needs);
    return did_so && names_all(failure.needs, needs) && std::ranges::all_of(words, [&](const std::string& word) {
             return names_all(failure.traits, {word}) || says(failure, word);
           });
  }
};

bool is_sure(const FailureNeeds& failure) { return !failure.is_rare; }

// Puts failures of one agent with one end together: those with the same needs whose bodies did the same.
class Gathering {
 public:
  using Key = std::pair<Needs, std::string>;

  explicit Gathering(std::span<const KnownFailure> failures) : failures_(failures) {}
  void add(std::size_t member) {
    by_needs_[failures_[member].needs.needs].push_back(member);
    ++count_;
  }

  std::map<Key, Members> gathered() const {
    const std::vector<Home> all = homes();
    std::map<Key, Members> gathered;
    for (const auto& [needs, members] : by_needs_) {
      Members others, rare;
      for (const std::size_t member : members) {
        const auto home = std::ranges::find_if(all, [&](const Home& h) { return h.takes(failures_[member].needs); });
        if (home != all.end()) {
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
        homes.push_back({needs, doing, common_traits(failures_, part), part.size()});
        std::erase(homes.back().words, kThirdAgvTrait);  // who fails without a third AGV fails in the same way
      }
    }
    add_cores_of_words(homes);
    add_cores(homes);
    std::ranges::stable_sort(homes, {}, [](const Home& home) { return std::pair(home.needs.size(), ~home.size); });
    return homes;
  }

  // An agent with few failures, most of which say the same telling word: each shows that the others do without what it
  // does not need. Where they are many, the frequent needs say more: a failure may come about in one of several ways.
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
      const bool is_rule = members.size() >= 2 && 2 * members.size() >= count_;
      if (!is_rule || members.size() >= kEnoughToCount) continue;
      const Needs core = without_kinds(in_common(members));  // so few do not tell which kinds are chance
      const auto needs_no_more = [&](std::size_t member) { return failures_[member].needs.needs == core; };
      if (core.empty() && std::ranges::none_of(members, needs_no_more)) continue;
      for (const auto& [doing, part] : parted(failures_, members)) {
        if (!part.empty()) homes.push_back({core, doing, {word}, part.size()});
      }
    }
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
        const bool is_taken = std::ranges::any_of(homes, [&](const Home& home) { return home.takes(failure); });
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
      homes.push_back({in_common(sharing), "", {}, most->second});
      std::erase_if(left, has_it);
    }
  }

  std::span<const KnownFailure> failures_;
  std::map<Needs, Members> by_needs_;
  std::size_t count_ = 0;
};

// Of those that need no more than the mechanism does: few AGVs, no stroke of luck, an early failure.
std::size_t simplest(std::span<const KnownFailure> failures, const Members& members, const Needs& needs) {
  const auto effort = [&](std::size_t member) {
    const FailureNeeds& failure = failures[member].needs;
    return std::tuple(failure.needs != needs, failure.reduced.scenario.agvs.size(), failure.failing_lucks < kSomeLucks,
                      failure.reduced.failure.at, failures[member].run);
  };
  return *std::ranges::min_element(members, {}, effort);
}

}  // namespace

std::string Mechanism::text() const {
  std::string text = end;
  text += needs.empty() ? "; needs nothing" : fmt::format("; needs {}", fmt::join(needs, ", "));
  if (!doing.empty()) text += "; " + doing;
  if (!traits.empty()) text += fmt::format("; {}", fmt::join(traits, "; "));
  return text;
}

std::string Finding::id() const {
  const Mechanism named{mechanism.end, mechanism.needs, mechanism.doing, {}};
  return fmt::format("F-{:08x}", name_hash(agent + ": " + named.text()) >> 32);
}

std::vector<Finding> findings_of(std::span<const KnownFailure> failures) {
  std::map<std::pair<std::string, std::string>, Gathering> gatherings;
  for (std::size_t i = 0; i < failures.size(); ++i)
    gatherings.try_emplace({failures[i].agent, failures[i].needs.end}, failures).first->second.add(i);
  std::vector<Finding> findings;
  for (const auto& [of, gathering] : gatherings) {
    for (const auto& [key, members] : gathering.gathered()) {
      const auto& [needs, doing] = key;
      Finding finding;
      finding.agent = of.first;
      finding.mechanism = {of.second, needs, doing, common_traits(failures, members)};
      finding.members = members;
      finding.representative = simplest(failures, members, needs);
      findings.push_back(std::move(finding));
    }
  }
  std::ranges::stable_sort(findings, std::ranges::greater(), [](const Finding& f) { return f.members.size(); });
  return findings;
}

}  // namespace fleetproof
