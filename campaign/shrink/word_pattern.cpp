#include "campaign/shrink/word_pattern.hpp"

#include <algorithm>

namespace fleetproof {
namespace {

using Words = std::vector<std::string>;

bool has(const Words& words, const std::string& word) { return std::ranges::binary_search(words, word); }

void add(Words& words, const std::string& word) {
  const auto place = std::ranges::lower_bound(words, word);
  if (place == words.end() || *place != word) words.insert(place, word);
}

}  // namespace

bool WordPattern::match(const Words& words) const {
  return std::ranges::includes(words, telling) && std::ranges::includes(usual, words);
}

void WordLearner::hear_undisturbed(const CaseRun& run) {
  std::erase_if(telling_, [&](const std::string& word) { return has(run.all_words, word); });
  for (const std::string& word : run.all_words) add(usual_, word);
  undisturbed_.insert(run.all_words.begin(), run.all_words.end());
}

void WordLearner::hear_passing(const CaseRun& run) {
  ++passing_;
  for (const std::string& word : run.all_words) ++saying_[word];
}

void WordLearner::hear_failing(const CaseRun& run) {
  std::erase_if(telling_, [&](const std::string& word) { return !has(run.words, word); });
}

void WordLearner::keep_telling(const std::function<bool(const std::string& word)>& tells) {
  std::erase_if(telling_, [&](const std::string& word) { return !tells(word); });
}

bool WordLearner::is_ordinary(const std::string& word) const {
  const auto said = saying_.find(word);
  return undisturbed_.contains(word) || (said != saying_.end() && 2 * said->second >= passing_);
}

WordPattern WordLearner::pattern() const {
  WordPattern pattern{telling_, usual_};
  for (const auto& [word, count] : saying_) {
    if (10 * count <= 9 * passing_) continue;
    std::erase(pattern.telling, word);
    add(pattern.usual, word);
  }
  return pattern;
}

}  // namespace fleetproof
