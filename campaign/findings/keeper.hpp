#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "campaign/explain/explanation.hpp"
#include "campaign/findings/finding.hpp"
#include "campaign/findings/neighbourhood.hpp"
#include "campaign/shrink/shrink.hpp"

namespace fleetproof {

// A finding as it is kept: its simplest failure, made as small as possible, and why it fails.
struct FindingRecord {
  KeptFailure kept;
  ShrinkResult shrunk;
  Explanation explanation;
  NeighbourCounts neighbours;
};

// `trials`: of shrinking, at most. The result is the same for any number of workers.
FindingRecord record_of(CaseHost& host, const Finding& finding, const FailureNeeds& representative,
                        std::uint64_t trials);

}  // namespace fleetproof
