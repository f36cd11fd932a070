#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "campaign/shrink/failure_pattern.hpp"

namespace fleetproof {

// A sentence about a failing case that one simulated run shows. Whoever doubts it simulates the run again.
struct Claim {
  std::string sentence;
  Scenario run;
  ExpectedOutcome outcome;           // what the run shows
  bool avoids = false;               // the failure
  std::vector<std::string> words{};  // all that the fleet declared in the run, sorted; of runs without a thing only
  // Of a run without a thing: it is a fault or a shape, not one who only took part or made them meet.
  bool tells_why = false;
};

// How often a changed scenario fails in the same way with other draws: with_other_draws, by its numbers from 1 on.
struct Share {
  std::string what;  // "no message is late"
  Scenario run;      // with its own draws
  std::vector<std::uint32_t> failing_draws;
  std::size_t of = 0;                // 1: nothing is drawn that changes anything, so all draws are one run
  bool tells_why = false;            // it is about radio or faults, not about who takes part or what made them meet
  bool smallest_case_fails = false;  // with the change, too: then the failure does not need what it takes away

  std::size_t failing() const { return failing_draws.size(); }
};

// Whether a changed run avoids the failure: if bodies came too close, none do in any way; otherwise it does not fail in
// the same way.
bool avoids(const CaseRun& run, const FailingCase& failing, const FailurePattern& pattern);

// "AGV 3": as its scenario names it.
std::string name_of_body(const Scenario& scenario, EntityId body);
// "GRANT: answers 7.0"
std::string words_of(const std::string& kind, const std::string& content);
std::string words_of(const MessageDelivery& message);
// "message 118 (GRANT: answers 7.0, 5 to 2, 61.204 s)"
std::string message_text(const Scenario& scenario, const MessageDelivery& message);

}  // namespace fleetproof
