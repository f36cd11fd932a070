#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "campaign/explain/explanation.hpp"
#include "campaign/findings/finding.hpp"
#include "campaign/findings/neighbourhood.hpp"

namespace fleetproof {

// A finding as it is kept: its simplest failure, made as small as possible, and why it fails.
struct FindingRecord {
  KeptFailure kept;
  Explanation explanation;
  NeighbourCounts neighbours;
};

// A mended part of a fault may be all that one world needs, so others are kept, too.
inline constexpr std::size_t kOtherWorlds = 4;

// `trials`: of shrinking, at most. The explanation is that of the kept world. `others`: reduced failures of the
// finding, at most kOtherWorlds; if they are fewer, the fleet of the kept world is put elsewhere until it fails in the
// same way. The result is the same for any number of workers.
FindingRecord record_of(CaseHost& host, const Finding& finding, const FailureNeeds& representative,
                        std::uint64_t trials, const std::vector<FailingCase>& others = {});

// Members of the finding, spread over it: at most kOtherWorlds. Not its representative, and none that is rare: its
// neighbours would hardly fail.
std::vector<FailingCase> others_of(const Finding& finding, std::span<const KnownFailure> failures);

// Leaves the words that each of these failing neighbours had said: what some do without tells nothing, and its absence
// in other software is chance.
void keep_words_of_all(KeptFailure& kept, const NeighbourCounts& neighbours);

}  // namespace fleetproof
