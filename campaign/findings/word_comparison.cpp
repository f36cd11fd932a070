#include "campaign/findings/word_comparison.hpp"

#include <algorithm>

#include "campaign/shrink/other_draws.hpp"

namespace fleetproof {
bool WordComparison::is_telling(const std::string& word) const {
  const auto saying = std::ranges::count_if(passing_, [&](const CaseRun* run) { return says(*run, word); });
  return chance_that_all_say(failing_, static_cast<std::uint32_t>(saying),
                             static_cast<std::uint32_t>(passing_.size())) <= kRareChance;
}

// On another timeline, what happens may happen a little later.
bool WordComparison::says(const CaseRun& run, const std::string& word) const {
  return std::ranges::any_of(run.first_said, [&](const Declared& said) {
    const bool is_one = !failure_.a.valid() || said.agv == failure_.a || said.agv == failure_.b;
    return is_one && said.word == word && said.at <= failure_.at + kLatest;
  });
}

double chance_that_all_say(std::uint32_t failing, std::uint32_t saying, std::uint32_t passing) {
  double chance = 1.0;
  for (std::uint32_t i = 1; i <= failing; ++i) chance *= static_cast<double>(saying + i) / (passing + i);
  return chance;
}

}  // namespace fleetproof
