#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "campaign/findings/finding.hpp"
#include "campaign/shrink/case_host.hpp"

namespace fleetproof {

// So many runs without a need of a finding are tried by default.
inline constexpr std::uint64_t kTrialsPerNeed = 1000;

// What is tried to refute the needs of a finding.
struct RefutationSearch {
  std::span<const Scenario> smaller;  // cases that are known to fail as it does: shrunk, or kept
  // Of its members, in their order, as their campaign had them; the others, if they are fewer, only reduced.
  std::span<const Scenario> runs;
  std::uint64_t trials = kTrialsPerNeed;
};

// The needs of the finding, a third AGV among them, that are none: a run without it fails in the same way. That is a
// failure of the finding that did without it, a smaller case from which it is taken, or one of the trials: the reduced
// and the whole run of the representative, and in turns with it those of the other members, without it and with other
// timelines. "In the same way": with the
// same end, the words that tell it apart, and what the bodies did if that belongs to the mechanism. On all workers; the
// same for any number. If the time of the host is over, GivenUp is thrown, and `found` has what was found until then.
void add_refuted_needs(CaseHost& host, const Finding& finding, std::span<const KnownFailure> failures,
                       const RefutationSearch& search, std::vector<std::string>& found);

// The smallest cases of these runs, found with so many trials each: they may do without a need of the finding of the
// runs. One that does not fail gives none.
std::vector<Scenario> shrunk(CaseHost& host, std::span<const Scenario> runs, std::uint64_t trials);

}  // namespace fleetproof
