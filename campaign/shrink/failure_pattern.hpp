#pragma once

#include <cstdint>
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
  std::uint64_t digest = 0;  // of the trace of its run

  ExpectedOutcome expectation() const { return {text_of(failure.kind), digest}; }  // as a saved case has it
};

// What counts as the same failure: what went wrong between which bodies, and what their agents declared before it.
struct FailurePattern {
  FailureKind kind;  // of the failure that was looked at
  // Of its states, those that an AGV must be in again, each once: if both AGVs said it, one of them is enough. What
  // agents also say when all is well ("driving") is not asked for.
  std::vector<std::string> states{};
  WordPattern words{};
  // The failure of the run, if it is this one.
  std::optional<Failure> match(const CaseRun& run) const;
};

// The pattern of this failure. Its words are compared with runs of the same scenario without a failure: on a perfect
// radio, and with other draws.
FailurePattern pattern_of(CaseHost& host, const FailingCase& failing);

}  // namespace fleetproof
