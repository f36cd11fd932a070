#include "campaign/shrink/failure_pattern.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "campaign/shrink/adverse_fates.hpp"
#include "campaign/shrink/other_luck.hpp"

namespace fleetproof {
namespace {

constexpr std::uint32_t kOtherRuns = 16;

}  // namespace

std::optional<Failure> FailurePattern::match(const CaseRun& run) const {
  auto failure = failure_of(run);
  if (!failure || !(failure->kind == kind) || !std::ranges::includes(run.words, telling_words)) return std::nullopt;
  return failure;
}

FailurePattern pattern_of(CaseHost& host, const FailingCase& failing) {
  FailurePattern pattern{failing.failure.kind};
  std::vector<std::string> words = host(failing.scenario).words;
  const CaseRun lucky = host(with_fates_only(failing.scenario, {}));
  const bool lucky_fails = failure_of(lucky).has_value();
  if (!lucky_fails)
    std::erase_if(words, [&](const std::string& word) { return std::ranges::binary_search(lucky.all_words, word); });
  std::map<std::string, std::size_t> saying;
  std::size_t others = 0;
  for (std::uint32_t i = 1; i <= kOtherRuns && !words.empty(); ++i) {
    const CaseRun other = host(with_other_luck(failing.scenario, i));
    if (failure_of(other)) continue;
    ++others;
    for (const std::string& word : other.all_words) ++saying[word];
  }
  if (lucky_fails && others == 0) words.clear();  // nothing to compare with
  std::erase_if(words, [&](const std::string& word) { return 10 * saying[word] > 9 * others; });
  pattern.telling_words = std::move(words);
  return pattern;
}

}  // namespace fleetproof
