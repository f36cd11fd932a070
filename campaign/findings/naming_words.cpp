#include "campaign/findings/naming_words.hpp"

#include <algorithm>
#include <iterator>

#include "campaign/findings/ingredients.hpp"

namespace fleetproof {
namespace {

using Members = std::vector<std::size_t>;

// With fewer, what a word tells may be chance.
constexpr std::size_t kOftenTelling = 8;
// Of four failures that say it, it tells three: the fourth may have had too few runs to compare with.
constexpr std::size_t kTellingShare = 3, kTellingOf = 4;
// One failure in ten has to be without it, or there is nothing to tell apart.
constexpr std::size_t kSilentShare = 10;

// Words that tell failures apart in many runs, and hardly ever do not: where agents say them, that is the failure.
std::vector<std::string> naming_words(std::span<const KnownFailure> failures, const Members& members) {
  std::map<std::string, std::size_t> telling;
  for (const std::size_t member : members) {
    for (const std::string& trait : failures[member].needs.traits) {
      if (trait != kThirdAgvTrait) ++telling[trait];
    }
  }
  std::vector<std::string> naming;
  for (const auto& [trait, count] : telling) {
    const auto said = static_cast<std::size_t>(std::ranges::count_if(
        members, [&, &word = trait](std::size_t member) { return says(failures[member].needs, word); }));
    const bool tells = count >= kOftenTelling && kTellingOf * count >= kTellingShare * said;
    if (tells && kSilentShare * (members.size() - said) >= members.size()) naming.push_back(trait);
  }
  return naming;
}

}  // namespace

bool says(const FailureNeeds& failure, const std::string& trait) {
  return names_all(failure.traits, {trait}) ||
         std::ranges::any_of(failure.said, [&](const std::string& word) { return trait == trait_of_word(word); });
}

std::map<std::vector<std::string>, Members> by_naming_words(std::span<const KnownFailure> failures,
                                                            const Members& members) {
  const auto naming = naming_words(failures, members);
  std::map<std::vector<std::string>, Members> found;
  for (const std::size_t member : members) {
    std::vector<std::string> words;
    std::ranges::copy_if(naming, std::back_inserter(words),
                         [&](const std::string& word) { return says(failures[member].needs, word); });
    found[words].push_back(member);
  }
  return found;
}

}  // namespace fleetproof
