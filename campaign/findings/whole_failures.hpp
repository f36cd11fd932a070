#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "campaign/findings/neighbourhood.hpp"

namespace fleetproof {

// The runs of a kept failure, played with other draws. A world has only what its failure needs: often no third AGV,
// no restart, a perfect radio. Software in which another thing is broken may pass there, and fails in these.
inline constexpr std::uint32_t kWholeRuns = 1000;
// So many at most. None if the failure has no runs.
NeighbourCounts try_whole_runs(CaseHost& host, const KeptFailure& kept, std::uint32_t count = kWholeRuns);

// Whether a failure of a whole run may be a kept one. More than that one needs may be missing in other draws, and which
// kinds of messages are lost is chance; what the bodies did is not looked at.
bool may_be(const KeptFailure& kept, const FailureNeeds& found);

// What the first failures of the whole runs need that cannot be the kept one.
std::vector<std::vector<std::string>> needs_of_others(CaseHost& host, const KeptFailure& kept,
                                                      const NeighbourCounts& counts);

// How software failed in which a finding was found, beside the finding itself.
struct OtherKind {
  KeptFailure failure;  // without scenarios
  Words always_said{}, usually_said{};
  std::vector<Circumstances> circumstances{};  // of its whole runs
};
struct KnownRuns {
  NeighbourCounts counts;
  std::vector<OtherKind> others;
};

}  // namespace fleetproof
