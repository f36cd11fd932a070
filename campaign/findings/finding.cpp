#include "campaign/findings/finding.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "core/base/random.hpp"

namespace fleetproof {
namespace {

using Needs = std::vector<std::string>;
using Members = std::vector<std::size_t>;

// Shares of failures: with a trait that tells them from others, and with one that belongs to the mechanism.
constexpr std::size_t kTellingPercent = 90, kCommonPercent = 75;

// What the bodies did is never chance in three of four failures; words and company may be.
std::size_t common_percent(const std::string& trait) {
  const bool is_doing = trait != kThirdAgvTrait && trait.find('"') == std::string::npos;
  return is_doing ? kCommonPercent : kTellingPercent;
}

// Below this, a set of needs may be an accident of the luck with which it was looked for.
constexpr std::size_t kFewMembers = 3, kRareShare = 20;
constexpr std::uint32_t kSomeLucks = 4;

bool contains(const std::vector<std::string>& larger, const std::vector<std::string>& smaller) {
  return std::ranges::all_of(smaller, [&](const std::string& word) { return std::ranges::count(larger, word) > 0; });
}

std::vector<std::string> common_traits(std::span<const KnownFailure> failures, const Members& members) {
  std::map<std::string, std::size_t> having;
  for (const std::size_t member : members) {
    for (const std::string& trait : failures[member].needs.traits) ++having[trait];
  }
  std::vector<std::string> common;
  for (const auto& [trait, count] : having) {
    if (100 * count >= common_percent(trait) * members.size()) common.push_back(trait);
  }
  return common;
}

// The failures of one agent with one end, by what they need.
class Gathering {
 public:
  explicit Gathering(std::span<const KnownFailure> failures) : failures_(failures) {}
  void add(std::size_t member) { by_needs_[failures_[member].needs.needs].push_back(member), ++count_; }

  std::map<Needs, Members> gathered() const {
    std::vector<Home> homes;
    for (const auto& [needs, members] : by_needs_) {
      const bool is_rare = members.size() < kFewMembers || kRareShare * members.size() < count_;
      if (is_rare) continue;
      homes.push_back({needs, common_traits(failures_, members), members.size()});
      std::erase(homes.back().traits, kThirdAgvTrait);  // whoever needs less company needs nothing else
    }
    std::ranges::stable_sort(homes, {}, [](const Home& home) { return std::pair(home.needs.size(), ~home.size); });
    std::map<Needs, Members> gathered;
    for (const auto& [needs, members] : by_needs_) {
      for (const std::size_t member : members) gathered[home_of(failures_[member].needs, homes)].push_back(member);
    }
    for (auto& [needs, members] : gathered) std::ranges::sort(members);
    return gathered;
  }

 private:
  struct Home {
    Needs needs;
    std::vector<std::string> traits;
    std::size_t size = 0;
  };
  static Needs home_of(const FailureNeeds& failure, const std::vector<Home>& homes) {
    for (const Home& home : homes) {
      if (contains(failure.needs, home.needs) && contains(failure.traits, home.traits)) return home.needs;
    }
    return failure.needs;
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
  if (!traits.empty()) text += fmt::format("; {}", fmt::join(traits, "; "));
  return text;
}

std::string Finding::id() const { return fmt::format("F-{:08x}", name_hash(agent + ": " + mechanism.text()) >> 32); }

std::vector<Finding> findings_of(std::span<const KnownFailure> failures) {
  std::map<std::pair<std::string, std::string>, Gathering> gatherings;
  for (std::size_t i = 0; i < failures.size(); ++i)
    gatherings.try_emplace({failures[i].agent, failures[i].needs.end}, failures).first->second.add(i);
  std::vector<Finding> findings;
  for (const auto& [key, gathering] : gatherings) {
    for (const auto& [needs, members] : gathering.gathered()) {
      Finding finding;
      finding.agent = key.first;
      finding.mechanism = {key.second, needs, common_traits(failures, members)};
      finding.members = members;
      finding.representative = simplest(failures, members, needs);
      findings.push_back(std::move(finding));
    }
  }
  std::ranges::stable_sort(findings, std::ranges::greater(), [](const Finding& f) { return f.members.size(); });
  return findings;
}

}  // namespace fleetproof
