#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "campaign/shrink/failure_pattern.hpp"

namespace fleetproof {

// So many runs are simulated for one failure at most.
inline constexpr std::uint64_t kReplaysPerFailure = 200;
inline constexpr std::uint32_t kOtherRuns = 16;

// What one failing run needs, found by taking things away and simulating again, with other draws where it takes another
// timeline then. What is not named here was taken away, and the run still failed. What is named may be missing in a run
// that fails all the same, if such runs are rare.
struct FailureNeeds {
  std::string end;                  // "too close, two AGVs"
  std::vector<std::string> needs;   // ingredients, in the order of ingredients_of
  std::vector<std::string> doings;  // what the bodies did when `reduced` failed, beside driving on: "one turns"; sorted
  std::vector<std::string> traits;  // what else was true then: its agents said a word, there was a third AGV; sorted
  std::vector<std::string> said;    // all that the agents of its bodies had declared then; sorted
  FailingCase reduced;              // fails with nothing but what it needs
  std::uint32_t failing_draws = 0;  // of kOtherRuns runs of the scenario with other draws: that end alike
  bool is_rare = false;             // with no other draws it failed alike, so what it needs is not known
  std::uint64_t replays = 0;
};

// The id of a finding is a hash of its words, these among them: other words would make known findings new ones.
inline constexpr const char* kNotKnown = "not known: it failed with this luck only";
inline constexpr const char* kThirdAgvTrait = "needs a third AGV";

// "says "x"": as traits have it.
std::string trait_of_word(const std::string& word);

// How a failure ends, without what is chance: how close two bodies came, and at what speed.
std::string end_of(const Failure& failure);

// Whether a run fails as another one did: with the same end, and with the words that its agents say then.
struct FailureLikeness {
  std::string end;
  WordPattern words{};
  std::optional<Failure> match(const CaseRun& run) const;
};

// What the bodies of a failure did, beside driving on: "one turns"; sorted.
std::vector<std::string> doings_of(const CaseRun& run);

// Absent if the scenario does not fail, or not as it did before: `stored`. Threads: may be called from several, for one
// host.
std::optional<FailureNeeds> needs_of(CaseHost& host, const Scenario& scenario, const RunFailure* stored = nullptr);

}  // namespace fleetproof
