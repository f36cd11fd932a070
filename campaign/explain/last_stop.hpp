#pragma once

#include <vector>

#include "campaign/explain/claim.hpp"

namespace fleetproof {

// The last instant at which an AGV of the failure could have avoided it by braking, or by staying where it stood, to
// 0.1 s. The brake is a protective stop that the scenario adds.
struct LastStop {
  std::string agv;
  std::optional<SimTime> at;  // absent: no stop of this AGV that was tried avoids it
  std::vector<Claim> claims;  // the stop that avoids it, and the next one, which does not; or the earliest of all
};
// If the time of the host is over, GivenUp is thrown, and `found` has those that were found until then.
void add_last_stops(CaseHost& host, const FailingCase& failing, const FailurePattern& pattern,
                    std::vector<LastStop>& found);

}  // namespace fleetproof
