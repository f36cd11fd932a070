#pragma once

#include <vector>

#include "campaign/explain/claim.hpp"

namespace fleetproof {

// A message that arrives so long after it was sent avoids the failure, and one that arrives up to 10 ms later does not.
struct LatestArrival {
  Duration in_time{}, too_late{};
};

// What one adverse message did.
struct MessageNeed {
  MessageDelivery message;
  bool is_needed = false;               // had it arrived at once and once, the run would avoid the failure
  std::optional<LatestArrival> latest;  // that avoids the failure; if it is needed
  std::vector<Claim> claims;
};
// Of all messages whose losses and delays the scenario names. While the radio draws, also of the last ones between the
// two bodies of the failure that it lost or delayed, of which only those that are needed are kept.
// If the time of the host is over, GivenUp is thrown, and `found` has those that were found until then.
void add_message_needs(CaseHost& host, const FailingCase& failing, const FailurePattern& pattern,
                       std::vector<MessageNeed>& found);

// For each AGV, order, fault and obstacle of the case, and for each bend on which a body of the failure was: the run
// without it.
std::vector<Claim> without_each_thing(CaseHost& host, const FailingCase& failing, const FailurePattern& pattern);

}  // namespace fleetproof
