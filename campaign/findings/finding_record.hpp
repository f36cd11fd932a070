#pragma once

#include <cstdint>
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

// `trials`: of shrinking, at most. The explanation is that of the kept world. The result is the same for any number of
// workers.
FindingRecord record_of(CaseHost& host, const Finding& finding, const FailureNeeds& representative,
                        std::uint64_t trials);

// Leaves the words that each of these failing neighbours had said: what some do without tells nothing, and its absence
// in other software is chance.
void keep_words_of_all(KeptFailure& kept, const NeighbourCounts& neighbours);

}  // namespace fleetproof
