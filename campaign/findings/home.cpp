#include "campaign/findings/home.hpp"

#include <algorithm>

#include "campaign/findings/ingredients.hpp"
#include "campaign/findings/naming_words.hpp"

namespace fleetproof {
namespace {

bool did_its_doing(const Home& home, const FailureNeeds& failure) {
  return home.doing.empty() || names_all(failure.doings, {home.doing});
}

bool says_its_words(const Home& home, const FailureNeeds& failure) {
  return std::ranges::all_of(home.words, [&](const std::string& word) { return says(failure, word); });
}

}  // namespace

// A failure with these draws only has no kinds of messages in `needed`: none of them is known to be no chance.
bool Home::takes(const FailureNeeds& failure, const std::vector<std::string>& needed) const {
  const bool did_so = did_its_doing(*this, failure) || (failure.doings.empty() && needed == needs);
  const bool needs_all = std::ranges::all_of(
      needs, [&](const std::string& need) { return names_all(needed, {need}) || names_all(failure.needs, {need}); });
  const bool needs_so = is_told_by_words || needed == needs || (takes_more && needs_all);
  return did_so && needs_so && says_its_words(*this, failure);
}

bool Home::is_like(const FailureNeeds& failure) const {
  const bool shares_the_rarest = !needs.empty() && names_all(failure.needs, {needs.front()});
  return !is_last && (shares_the_rarest || !words.empty()) && did_its_doing(*this, failure) &&
         says_its_words(*this, failure);
}

const Home* home_of(const FailureNeeds& failure, const std::vector<std::string>& needed,
                    const std::vector<Home>& homes) {
  const auto place = [&](const Home& home) {
    return home.needs.empty() ? 0 : std::ranges::find(needed, home.needs.front()) - needed.begin();
  };
  const Home* best = nullptr;
  for (const Home& home : homes) {
    if (!home.takes(failure, needed) || (home.is_last && best != nullptr)) continue;
    const bool is_as_simple = best != nullptr && home.needs.size() == best->needs.size();
    if (best == nullptr || (is_as_simple && place(home) < place(*best))) best = &home;
  }
  return best;
}

const Home* related_home(const FailureNeeds& failure, const std::vector<Home>& homes) {
  const auto home = std::ranges::find_if(homes, [&](const Home& h) { return h.is_like(failure); });
  return home == homes.end() ? nullptr : &*home;
}

}  // namespace fleetproof
