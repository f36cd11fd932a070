#pragma once

#include <optional>
#include <string>
#include <vector>

#include "campaign/shrink/case_host.hpp"
#include "campaign/shrink/word_pattern.hpp"

namespace fleetproof {

// A scenario that fails in the way that is looked for.
struct FailingCase {
  Scenario scenario;
  Failure failure;
};

// What counts as the same failure: its kind, and what its agents declared before it.
struct FailurePattern {
  FailureKind kind;
  WordPattern words{};
  // The failure of the run, if it is this one.
  std::optional<Failure> match(const CaseRun& run) const;
};

// The pattern of this failure. Its words are compared with runs of the same scenario without a failure: on a perfect
// radio, and with other luck.
FailurePattern pattern_of(CaseHost& host, const FailingCase& failing);

}  // namespace fleetproof
