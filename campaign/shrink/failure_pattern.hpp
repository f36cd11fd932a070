#pragma once

#include <optional>
#include <string>
#include <vector>

#include "campaign/shrink/case_host.hpp"

namespace fleetproof {

// A scenario that fails in the way that is looked for.
struct FailingCase {
  Scenario scenario;
  Failure failure;
};

// What counts as the same failure: its kind, and words of its agents that not every run without a failure has.
struct FailurePattern {
  FailureKind kind;
  std::vector<std::string> telling_words{};  // sorted
  // The failure of the run, if it is this one.
  std::optional<Failure> match(const CaseRun& run) const;
};

// The pattern of this failure. Telling are the words that its agents declared before it, unless a run of the same
// scenario without a failure declares them too: on a perfect radio, or nine in ten of such runs with other luck.
FailurePattern pattern_of(CaseHost& host, const FailingCase& failing);

}  // namespace fleetproof
