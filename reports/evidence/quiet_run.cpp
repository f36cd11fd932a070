#include "reports/evidence/quiet_run.hpp"

#include <algorithm>

#include "core/outcome/foreign_bodies.hpp"
#include "core/outcome/run_result.hpp"
#include "reports/evidence/failing_run.hpp"

namespace fleetproof {

bool is_quiet(const RunRecord& run) {
  const Outcome& outcome = run.outcome;
  const bool is_told =
      std::ranges::any_of(outcome.incidents, [](const Incident& incident) { return !is_condition(incident.kind); });
  if (is_told || outcome.outcome_class() != OutcomeClass::Clean || !outcome.violations.empty()) return false;
  if (FailingRun::of(run) || met_foreign_bodies(outcome) || outcome.counters.processor_changes > 0) return false;
  return std::ranges::all_of(kValuesOf<EndPoint>, [&](EndPoint end_point) {
    return end_point == EndPoint::Throughput || result_of(outcome, end_point) == RunResult::Passed;
  });
}

}  // namespace fleetproof
