#pragma once

#include <vector>

#include "campaign/explain/last_stop.hpp"
#include "campaign/explain/necessity.hpp"
#include "campaign/explain/no_return.hpp"
#include "campaign/explain/set_offs.hpp"
#include "campaign/explain/shares.hpp"

namespace fleetproof {

// Why a run fails. All that is said of single messages, things, stops and drives is about `small`, the smallest case
// that fails in the same way; shares and the curve are about the run itself.
struct Explanation {
  FailingCase original, small;
  FailurePattern pattern;
  std::vector<MessageNeed> messages;
  std::vector<Claim> things;
  std::vector<LastStop> stops;
  std::vector<SetOff> set_offs;
  std::vector<Departure> past_drives;  // of those AGVs of the failure that were on no drive: the last before it
  CaseNotes notes;                     // of the smallest case
  std::vector<std::string> doing;      // what its AGVs did when it failed, as CaseRun has it
  std::string ended;                   // of a crash or a hang: what the engine says of it, after the name of the agent
  // All words of its agents on a perfect radio, sorted; none if it fails there, too.
  std::vector<std::string> undisturbed_words;
  std::vector<Share> shares;
  NoReturn no_return;
};

// Requires: both fail in the way of the pattern.
Explanation explain(CaseHost& host, const FailingCase& original, const FailingCase& small,
                    const FailurePattern& pattern);

// The runs that show what is said of single messages, things, stops and drives, in this order.
std::vector<const Claim*> claims_of(const Explanation& explanation);

}  // namespace fleetproof
