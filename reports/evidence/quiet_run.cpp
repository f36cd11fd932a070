#include "reports/evidence/quiet_run.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/outcome/foreign_bodies.hpp"
#include "core/outcome/run_result.hpp"
#include "reports/evidence/evidence.hpp"
#include "reports/evidence/failing_run.hpp"

namespace fleetproof {

bool is_silent(const Outcome& outcome) { return outcome.agv_count > 1 && outcome.counters.messages_sent == 0; }

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

MayFold quiet_runs_of(const StoredPlan& plan) {
  std::vector<bool> is_tested;  // by cell
  for (const CellRecord& cell : plan.cells) is_tested.push_back(is_under_test(plan, cell.agent));
  return [is_tested = std::move(is_tested)](const RunRecord& run) {
    return is_quiet(run) && !(is_tested.at(run.cell) && is_silent(run.outcome));
  };
}

}  // namespace fleetproof
