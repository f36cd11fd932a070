#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "campaign/run/case_run.hpp"

namespace fleetproof {

// What agents declare in each run that fails in one way. All lists are sorted.
struct WordPattern {
  std::vector<std::string> telling;  // said each time, but not in nearly every run without a failure
  // What was said in the run that failed, on a perfect radio, or in nearly every run without a failure. Who says
  // another word before a failure fails for another reason.
  std::vector<std::string> usual;

  // `words`: as CaseRun has them.
  bool match(const std::vector<std::string>& words) const;
};

// Learns it from runs of one scenario and of scenarios like it.
class WordLearner {
 public:
  explicit WordLearner(const CaseRun& failing) : telling_(failing.words), usual_(failing.words) {}
  // On a perfect radio, without a failure: whatever is said there is usual.
  void hear_undisturbed(const CaseRun& run);
  void hear_passing(const CaseRun& run);
  void hear_failing(const CaseRun& run);
  // Other words do not tell.
  void keep_telling(const std::function<bool(const std::string& word)>& tells);
  std::uint32_t passing() const { return passing_; }
  WordPattern pattern() const;
  // Whether the fleet says the word without a failure: on a perfect radio, or in at least half of the other runs.
  bool is_ordinary(const std::string& word) const;

 private:
  std::vector<std::string> telling_, usual_;
  std::set<std::string> undisturbed_;
  std::map<std::string, std::uint32_t> saying_;  // of the runs without a failure
  std::uint32_t passing_ = 0;
};

}  // namespace fleetproof
