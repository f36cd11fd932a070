#pragma once

#include <cstdint>

#include "storage/records.hpp"

namespace fleetproof {

// What one run says about an end point. Unknown: the run ended, lost an AGV, or met a body that no software is told of,
// before this could be decided.
enum class RunResult : std::uint8_t { Passed, Failed, Unknown };

// A run fails an end point of progress (deadlock, livelock, starvation, standstill) only by what happened before its
// first contact: what stands behind a wreck is its consequence, and then the end point is unknown. The same holds if an
// agent crashed or hung. A run in which AGVs came too close to fallen loads or obstacles only, which control software
// is never told of, is unknown; so is a standstill while such a body lay on the floor (foreign_bodies.hpp). Requires:
// `end_point` is not Throughput, which takes more than one run.
RunResult result_of(const Outcome& outcome, EndPoint end_point);

}  // namespace fleetproof
