#pragma once

#include "storage/records.hpp"

namespace fleetproof {

// Whether nothing went wrong in the run: no end point failed or stayed unknown, no law accuses anybody, the scenario
// got what it asked for, no foreign body was met, no agent changed the state of the processor. Reports then count what
// the run did and met, and name it nowhere. Throughput is judged by what it did.
bool is_quiet(const RunRecord& run);

}  // namespace fleetproof
