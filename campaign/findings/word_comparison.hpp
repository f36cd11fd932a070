#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "campaign/run/case_run.hpp"

namespace fleetproof {

// Asks whether runs that fail alike say a word more often than runs of the same scenario with other draws that do not
// fail. A word that losses and delays make any AGV say ("grant-lost") tells nothing of a failure, though all of its
// runs say it.
class WordComparison {
 public:
  explicit WordComparison(const Failure& failure) : failure_(failure) {}
  void add_failing() { ++failing_; }
  void add_passing(const CaseRun& run) { passing_.push_back(&run); }

  // Of a word that all failing runs say. Passing runs say it if an AGV of the failure had said it by then.
  bool is_telling(const std::string& word) const;

 private:
  bool says(const CaseRun& run, const std::string& word) const;

  const Failure& failure_;
  std::uint32_t failing_ = 1;  // the failure itself
  std::vector<const CaseRun*> passing_;
};

// Up to this chance, a word tells.
inline constexpr double kRareChance = 0.1;

// All of `failing` runs say a word, and `saying` of `passing` ones do: how probable that is if it is chance which of
// all these runs fail.
double chance_that_all_say(std::uint32_t failing, std::uint32_t saying, std::uint32_t passing);

}  // namespace fleetproof
