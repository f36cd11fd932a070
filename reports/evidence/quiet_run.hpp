#pragma once

#include "storage/fold.hpp"
#include "storage/records.hpp"

namespace fleetproof {

// Whether two or more AGVs were there and none of them sent a message.
bool is_silent(const Outcome& outcome);

// Whether nothing went wrong in the run: no end point failed or stayed unknown, no law accuses anybody, the scenario
// got what it asked for, no foreign body was met, no agent changed the state of the processor.
// Reports then count what the run did and met, and name it nowhere. Throughput is judged by what it did.
bool is_quiet(const RunRecord& run);

// The runs that a published file may fold: quiet ones. But of software under test a head counts the silent ones, and a
// folded run does not say whether it was.
MayFold quiet_runs_of(const StoredPlan& plan);

}  // namespace fleetproof
