#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/outcome/end_point.hpp"
#include "core/outcome/outcome.hpp"

namespace fleetproof {

// One thing that went wrong in a run.
struct RunFailure {
  // Absent: an end without an end point (stuck without a reason, indeterminate, an error of the engine).
  std::optional<EndPoint> end_point;
  std::string what;   // "contact, two AGVs"
  SimTime at{};       // when it began; of a crash, a hang and of an end without an end point: the end of the run
  SimTime seen{};     // from then on it was what it is: a violation may become a contact after it began
  EntityId a{}, b{};  // each invalid if not known
  bool is_violation = false;  // the two came too close
  bool is_judged = true;  // the software answers for it; otherwise it is a consequence, or what caused it is not known
  bool is_over = false;   // it had passed before the run ended

  std::uint32_t weight() const;  // of its end point (end_point.hpp); 0 without one
};

// All that went wrong in a run. The first one leads: what is judged comes before what is not, then the heavier end
// point, then the earlier one. Who hits a wreck or a fallen load did not cause that, so it leads only if nothing is
// judged. Empty: nothing went wrong.
std::vector<RunFailure> failures_of(const Outcome& outcome);

// Which failure of a run is looked at.
struct FailureChoice {
  std::uint32_t end_points = 0;  // of these (bit_of), the one that comes first; 0: the one that leads the run
  friend bool operator==(const FailureChoice&, const FailureChoice&) = default;
};
// Absent: the run has none.
std::optional<RunFailure> chosen_failure(const Outcome& outcome, FailureChoice choice);

// How the run ended, in words: its class, and if that is clean, the failure that leads it: "deadlock", or "starvation,
// not judged".
std::string end_of_run(const Outcome& outcome);

// Whether both are what went wrong between the same bodies.
bool is_same_failure(const RunFailure& a, const RunFailure& b);

}  // namespace fleetproof
