#pragma once

#include <atomic>
#include <cstdint>

#include "campaign/run/run_one.hpp"
#include "storage/records.hpp"

namespace fleetproof {

// What an audit finds about a run. `repeated` is the record of the run as a worker has made it once more. If it has a
// recording of what the agents did, that is played in this process, in which no plug-in has ever been: what comes out
// there counts, so that damage to the engine of a worker shows. `checksum_before`: of the row that the campaign stored.
// Throws RunAbandoned after `abandon`.
AuditedRun audit_finding(const RunOne& run_one, const RunRecord& repeated, std::uint64_t checksum_before,
                         const std::atomic<bool>* abandon = nullptr);

}  // namespace fleetproof
