#pragma once

#include <vector>

#include "campaign/explain/claim.hpp"

namespace fleetproof {

// What one adverse message did, in a case whose luck is written down.
struct MessageNeed {
  MessageFate message;
  bool is_needed = false;         // had it arrived at once and once, the run would avoid the failure
  std::optional<Duration> saves;  // so late it may arrive at most to avoid the failure, to 10 ms; if it is needed
  std::vector<Claim> claims;
};
std::vector<MessageNeed> needs_of_messages(CaseHost& host, const FailingCase& failing, const FailurePattern& pattern);

// For each AGV, order, fault and obstacle of the case: the run without it.
std::vector<Claim> without_each_thing(CaseHost& host, const FailingCase& failing, const FailurePattern& pattern);

}  // namespace fleetproof
