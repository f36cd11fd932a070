#pragma once

#include <optional>
#include <string>
#include <vector>

#include "campaign/shrink/failure_pattern.hpp"

namespace fleetproof {

// A sentence about a failing case that one simulated run shows. Whoever doubts it simulates the run again.
struct Claim {
  std::string sentence;
  Scenario run;
  std::string outcome;  // of the run: "contact, two AGVs (driving, driving)", or "none"
};

// How often a changed scenario fails in the same way, each time with other luck.
struct Share {
  std::string what;  // "without faults"
  std::size_t failing = 0, of = 0;
};

// Whether a changed run avoids the failure: if bodies came too close, none do in any way; otherwise it does not fail in
// the same way.
bool avoids(const CaseRun& run, const FailingCase& failing, const FailurePattern& pattern);

// What the run with this scenario shows: how it fails, or "none".
std::string outcome_text(const std::optional<Failure>& failure);

// "AGV 3": as its scenario names it.
std::string name_of_body(const Scenario& scenario, EntityId body);
// "GRANT, 5 to 2, 61.204 s"
std::string message_text(const Scenario& scenario, const MessageFate& message);

}  // namespace fleetproof
