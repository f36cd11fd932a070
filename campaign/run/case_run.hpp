#pragma once

#include <optional>
#include <string>
#include <vector>

#include "campaign/run/case_notes.hpp"
#include "campaign/run/itinerary.hpp"
#include "campaign/run/message_deliveries.hpp"
#include "core/engine/fleet_software.hpp"
#include "core/engine/run_watch.hpp"
#include "core/outcome/run_failures.hpp"
#include "core/scenario/scenario.hpp"

namespace fleetproof {

// What an AGV may do when a run fails: "bend" is a drive on a lane that is not straight.
inline constexpr const char *kTurning = "turn", *kOnABend = "bend", *kBackward = "backward", *kDriving = "drive",
                            *kTransferring = "transfer", *kStanding = "stand";

// One scenario, simulated to learn how it fails.
struct CaseRun {
  Outcome outcome;
  FailureChoice choice{};  // the failure that all of this is about
  // What the agents of the bodies of that failure had last declared when it happened, in the order of the bodies.
  // Empty: the run did not fail, no body is known, or no agent declares anything.
  std::vector<std::string> states;
  // What these AGVs did then, in the order of the bodies.
  std::vector<std::string> doing;
  // All states and probes that these agents had declared until then, sorted, each once; of the whole fleet if none of
  // its AGVs is known to have failed. And those of the whole fleet in the whole run.
  std::vector<std::string> words, all_words;
  std::vector<Declared> first_said;         // by each AGV, in the whole run: the first time that it declared each word
  std::vector<MessageDelivery> deliveries;  // of all messages, if they were asked for
  CaseNotes notes;                          // until the failure, if they were asked for
  Itinerary itinerary;                      // of the whole run, if it was asked for
  std::string recording;                    // what its agents did, if it was asked for and is not too long
};
enum class Deliveries : bool { Ignored, Kept };

// Under the default laws without those in `laws_left_out`.
CaseRun run_case(const Scenario& scenario, const FleetSoftware& software, const std::vector<std::string>& laws_left_out,
                 Deliveries deliveries = Deliveries::Ignored, const RunWatch& watch = {}, FailureChoice choice = {});

// How a run failed: two runs fail in the same way if their kinds are equal.
struct FailureKind {
  std::string what;                 // "contact, two AGVs"
  std::vector<std::string> states;  // of its AGVs, sorted

  friend bool operator==(const FailureKind&, const FailureKind&) = default;
};
// "contact, two AGVs (driving, waiting)"
std::string text_of(const FailureKind& kind);

// The run as a saved case expects it.
ExpectedOutcome expectation_of(const CaseRun& run);

struct Failure {
  FailureKind kind;
  SimTime at{};               // when it began
  SimTime seen{};             // from then on it was what it is
  EntityId a, b;              // each invalid if not known
  bool is_violation = false;  // the two came too close
};
// The failure that the run was to be looked at for; absent if it has none. Of a crash or a hang, `at` is the end of the
// run.
std::optional<Failure> failure_of(const CaseRun& run);

}  // namespace fleetproof
