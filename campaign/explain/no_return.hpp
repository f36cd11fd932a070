#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "campaign/shrink/failure_pattern.hpp"

namespace fleetproof {

// So many branches leave the run at each instant. If none of them fails, less than 5 % do (95 %): 1 - 0.05^(1/59).
inline constexpr std::size_t kBranches = 59, kInstants = 20;

// What becomes of a run if the radio draws anew from an instant on: with_other_radio, numbers 1 to kBranches.
struct Branching {
  SimTime at{};
  Scenario run;                              // the delivery of what is sent before `at` is given
  std::vector<std::uint32_t> failing_draws;  // in the same way, the same bodies, soon after the run itself at last

  std::size_t failing() const { return failing_draws.size(); }
};

// The curve of no return, in order of time: when the failure became likely, and when it became certain.
struct NoReturn {
  std::vector<Branching> curve;
  // Behind the last instant from which less than half of the branches fail, the failure is likely; from the first
  // instant on, behind which all fail, it is certain. Absent: not in the time that was looked at.
  std::optional<SimTime> likely_from, certain_from;
  // The last instant at which not all branches fail, and no more than at the first, as far as their number can tell
  // (two standard errors): what decided it lies between there and certain_from.
  SimTime open_until{};
  // Where that is later than certain_from: when the last of the drives began that failed. What decides them is sent
  // before it is certain, and acted upon by then.
  std::optional<SimTime> acted_by{};
};
// Requires: a curve that is not empty.
NoReturn judged(std::vector<Branching> curve);

// Branches a run whose radio draws. The instants lie before the failure, the last ones close to it; each branch keeps
// all that was sent before its instant as it was.
NoReturn curve_of_no_return(CaseHost& host, const FailingCase& failing, const FailurePattern& pattern);

}  // namespace fleetproof
