#include "reports/evidence/tally.hpp"

#include "core/outcome/work_and_progress.hpp"
#include "reports/evidence/quiet_run.hpp"

namespace fleetproof {

Tally Tally::of(const RunRecord& run, RunResult violation) {
  const Outcome& outcome = run.outcome;
  Tally one;
  one.runs = 1;
  one.violating_runs = violation == RunResult::Failed;
  one.unknown_runs = violation == RunResult::Unknown;
  one.repeats = run.repeats;
  one.passing_repeats = run.repeats && violation == RunResult::Passed;
  one.contact_runs = outcome.contact;
  one.hazardous_contact_runs = std::ranges::any_of(
      outcome.violations, [](const Violation& v) { return level_of(v) == ViolationLevel::HazardousContact; });
  one.stuck_runs = outcome.stuck;
  one.crash_runs = outcome.crash;
  one.hang_runs = outcome.hang;
  one.indeterminate_runs = outcome.indeterminate;
  one.engine_error_runs = outcome.engine_error;
  one.silent_runs = !run.folded && is_silent(outcome);
  one.transports_done = outcome.counters.transports_done;
  one.agv_us = fleetproof::agv_us(outcome.simulated_ns, outcome.agv_count);
  one.longest_ns = outcome.simulated_ns;
  one.agvs = outcome.agv_count;
  one.unmeasured_runs = has_measured_clearance(outcome) ? 0 : 1;
  one.min_clearance_um = outcome.min_clearance_um;
  return one;
}

void Tally::add(const Tally& other) {
  for (const auto count : {&Tally::runs, &Tally::violating_runs, &Tally::contact_runs, &Tally::hazardous_contact_runs,
                           &Tally::stuck_runs, &Tally::crash_runs, &Tally::hang_runs, &Tally::indeterminate_runs,
                           &Tally::engine_error_runs, &Tally::unknown_runs, &Tally::repeats, &Tally::passing_repeats,
                           &Tally::unmeasured_runs, &Tally::silent_runs, &Tally::transports_done, &Tally::agv_us}) {
    this->*count += other.*count;
  }
  longest_ns = std::max(longest_ns, other.longest_ns);
  agvs = std::max(agvs, other.agvs);
  if (other.min_clearance_um)
    min_clearance_um = std::min(min_clearance_um.value_or(*other.min_clearance_um), *other.min_clearance_um);
}

void Tally::add(const QuietRuns& quiet) {
  Tally all;
  all.runs = quiet.runs;
  all.transports_done = quiet.transports_done;
  all.agv_us = quiet.runs * fleetproof::agv_us(quiet.simulated_ns, quiet.agv_count);
  all.longest_ns = quiet.simulated_ns;
  all.agvs = quiet.agv_count;
  all.min_clearance_um = quiet.min_clearance_um;
  add(all);
}

std::optional<double> Tally::transports_per_agv_hour() const {
  if (agv_us == 0) return std::nullopt;
  return fleetproof::transports_per_agv_hour(transports_done, agv_hours());
}

}  // namespace fleetproof
