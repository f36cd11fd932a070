#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "campaign/explain/explanation.hpp"
#include "campaign/findings/finding.hpp"
#include "campaign/findings/neighbourhood.hpp"
#include "campaign/findings/whole_failures.hpp"

namespace fleetproof {

// A finding as it is kept: its simplest failure, made as small as possible, and why it fails.
struct FailureAnalysis {
  KeptFailure kept;
  Explanation explanation;
  NeighbourCounts neighbours;
  NeighbourCounts whole_runs;                         // of the kept runs
  std::vector<std::vector<std::string>> others_need;  // as needs_of_others has it
};

// A mended part of a fault may be all that one world needs, so others are kept, too.
inline constexpr std::size_t kOtherWorlds = 4;

// Of a finding, beside its representative.
struct FurtherFailures {
  std::vector<FailingCase> others{};  // reduced failures, at most kOtherWorlds
  std::vector<Scenario> runs{};       // failing runs as the campaign had them
};
// `trials`: of shrinking, at most. The explanation is that of the kept world. If there are few others, the fleet of the
// kept world is put elsewhere until it fails in the same way. The result is the same for any number of workers.
FailureAnalysis analysis_of(CaseHost& host, const Finding& finding, const FailureNeeds& representative,
                            std::uint64_t trials, const FurtherFailures& worlds = {});

// Members of the finding, spread over it: at most kOtherWorlds. Not its representative, and none that is rare: its
// neighbours would hardly fail.
std::vector<std::size_t> other_members(const Finding& finding, std::span<const KnownFailure> failures);
std::vector<FailingCase> others_of(const Finding& finding, std::span<const KnownFailure> failures);

// Leaves the words that each of these failing neighbours had said: what some do without tells nothing, and its absence
// in other software is chance.
void keep_words_of_all(KeptFailure& kept, const NeighbourCounts& neighbours);

}  // namespace fleetproof
