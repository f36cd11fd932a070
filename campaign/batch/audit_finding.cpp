#include "campaign/batch/audit_finding.hpp"

#include <optional>

#include "core/base/error.hpp"
#include "reports/evidence/audit_share.hpp"
#include "storage/checksum.hpp"

namespace fleetproof {

AuditedRun audit_finding(const RunOne& run_one, const RunRecord& repeated, std::uint64_t checksum_before,
                         const std::atomic<bool>* abandon) {
  const auto found = [&](const RunRecord& run) {
    const std::uint64_t checksum = row_checksum(run);
    return AuditedRun{{run.run_index, checksum, audited_outcome(run)}, checksum == checksum_before};
  };
  if (repeated.recording.empty()) return found(repeated);
  RunWatch watch;
  watch.play = repeated.recording;
  watch.abandon = abandon;
  try {
    return found(run_one(repeated.run_index, nullptr, watch));
  } catch (const EngineError&) {  // what it did is not known
    return {{repeated.run_index, row_checksum(repeated) ^ 1, std::nullopt}, false};
  }
}

}  // namespace fleetproof
