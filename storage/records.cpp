#include "storage/records.hpp"

#include "core/outcome/run_result.hpp"

namespace fleetproof {

AuditedOutcome audited_outcome(const RunRecord& run) {
  const Outcome& outcome = run.outcome;
  AuditedOutcome audited;
  audited.judged = judged(outcome);
  audited.digest = outcome.digest;
  audited.transports_done = outcome.counters.transports_done;
  audited.simulated_ns = outcome.simulated_ns;
  audited.agv_count = outcome.agv_count;
  audited.violations = outcome.violations.size();
  audited.contacts = static_cast<std::uint64_t>(std::ranges::count(outcome.violations, true, &Violation::contact));
  audited.incidents = outcome.incidents.size();
  return audited;
}

}  // namespace fleetproof
