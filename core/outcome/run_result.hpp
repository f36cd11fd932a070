#pragma once

#include <cstdint>

#include "core/outcome/end_point.hpp"
#include "core/outcome/outcome.hpp"

namespace fleetproof {

// What one run says about an end point. Unknown: the run ended, lost an AGV, or met a body that no software is told of,
// before this could be decided.
enum class RunResult : std::uint8_t { Passed, Failed, Unknown };

// A run fails an end point of progress (deadlock, livelock, starvation, standstill) only by what happened before its
// first contact: what stands behind a wreck is its consequence, and then the end point is unknown. If an agent crashed
// or hung, or the run ended early for another reason, these end points are unknown, also if the incident came before. A
// run in which AGVs came too close to fallen loads or obstacles only, which control software is never told of, is
// unknown; so is a lack of progress while such a body lay on the floor (foreign_bodies.hpp). Requires: `end_point` is
// not Throughput, which takes more than one run.
RunResult result_of(const Outcome& outcome, EndPoint end_point);

// Whether the run fails the end point of its kind by this incident. Requires: the kind has one.
bool fails_by(const Outcome& outcome, const Incident& incident);

// Of all end points but Throughput.
JudgedOutcome judged(const Outcome& outcome);
RunResult result_of(const JudgedOutcome& judged, EndPoint end_point);
// "failed": it failed an end point; "unknown": it failed none, and of some it says nothing; else "passed".
const char* judged_word(const JudgedOutcome& judged);

// An error of the simulator leaves the clearance unmeasured, and so does a crash after which nothing is known. In other
// runs, an absent clearance was never below 0.5 m.
bool has_measured_clearance(const Outcome& outcome);

}  // namespace fleetproof
