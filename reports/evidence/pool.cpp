#include "reports/evidence/pool.hpp"

#include <algorithm>
#include <utility>

#include "core/base/error.hpp"
#include "core/outcome/work_and_progress.hpp"
#include "reports/evidence/exposure.hpp"
#include "reports/evidence/foreign_bodies.hpp"
#include "reports/evidence/tally.hpp"

namespace fleetproof {
namespace {

RunResult worse(RunResult a, RunResult b) {
  if (a == RunResult::Failed || b == RunResult::Failed) return RunResult::Failed;
  return a == RunResult::Unknown || b == RunResult::Unknown ? RunResult::Unknown : RunResult::Passed;
}

}  // namespace

void PoolCounter::Count::add(RunResult result) {
  failing += result == RunResult::Failed ? 1 : 0;
  failing_or_unknown += result == RunResult::Passed ? 0 : 1;
}

PoolCounter::PoolCounter(Pool pool) : pool_(std::move(pool)) {
  if (pool_.rule.unit == GateUnit::Run) by_cell_.resize(pool_.cells.size());
}

RunResult PoolCounter::add(const RunRecord& run, RunResult violation) {
  const RunResult result = result_of_run(run.outcome, violation);
  if (pool_.rule.unit == GateUnit::AgvHour) add_time(run.outcome, result);
  pending_.result = worse(pending_.result, result);
  ++pending_.runs;
  if (pool_.rule.unit == GateUnit::Run) pending_.by_cell.push_back(result);
  if (result == RunResult::Failed) ++pool_.failing_runs;
  return result;
}

void PoolCounter::add_time(const Outcome& outcome, RunResult result) {
  const TimeAtRisk time = time_at_risk(outcome, pool_.rule.end_point, result);
  if (pending_.result == RunResult::Passed) pending_.at_risk.least_us += time.least_us;
  if (pending_.result != RunResult::Failed) pending_.at_risk.most_us += time.most_us;
}

RunResult PoolCounter::result_of_run(const Outcome& outcome, RunResult violation) {
  if (pool_.rule.end_point == EndPoint::Violation) return violation;
  if (pool_.rule.end_point != EndPoint::Throughput) return result_of(outcome, pool_.rule.end_point);
  // A crashed or hung AGV delivers nothing: that the fleet was slow then says nothing about its speed.
  if (result_of(outcome, EndPoint::Crash) != RunResult::Passed) return RunResult::Unknown;
  const bool foreign = met_foreign_bodies(outcome);
  if (pool_.rule.unit == GateUnit::Run)
    return throughput_result(outcome.counters.transports_done, agv_us(outcome.simulated_ns, outcome.agv_count),
                             foreign);
  pending_.foreign_body_lay |= foreign;
  pending_.transports_done += outcome.counters.transports_done;
  pending_.agv_us += agv_us(outcome.simulated_ns, outcome.agv_count);
  return RunResult::Passed;  // the world decides
}

RunResult PoolCounter::throughput_result(std::uint64_t transports_done, std::uint64_t agv_us,
                                         bool foreign_body_lay) const {
  if (agv_us == 0) return RunResult::Unknown;
  const bool enough = transports_per_agv_hour(transports_done, agv_hours(agv_us)) >= pool_.rule.floor_per_agv_hour;
  if (enough) return RunResult::Passed;
  return foreign_body_lay ? RunResult::Unknown : RunResult::Failed;
}

void PoolCounter::finish_replicate() {
  if (pool_.cells.empty()) return;
  ensure(pending_.runs == pool_.cells.size(), "a complete replicate has a run in every cell");
  if (pool_.rule.end_point == EndPoint::Throughput && pool_.rule.unit == GateUnit::World &&
      pending_.result == RunResult::Passed) {
    pending_.result = throughput_result(pending_.transports_done, pending_.agv_us, pending_.foreign_body_lay);
    pool_.failing_runs += pending_.result == RunResult::Failed ? 1 : 0;
  }
  Count world{pool_.failing, pool_.failing_or_unknown};
  world.add(pending_.result);
  const bool by_time = pool_.rule.unit == GateUnit::AgvHour;
  pool_.units += by_time ? pending_.at_risk.least_us : 1;
  pool_.most_units += by_time ? pending_.at_risk.most_us : 1;
  pool_.failing = world.failing;
  pool_.failing_or_unknown = world.failing_or_unknown;
  if (pool_.rule.unit == GateUnit::Run) count_cells();
  pending_ = Pending{};
}

void PoolCounter::add(const QuietReplicates& quiet) {
  ensure(pool_.rule.end_point != EndPoint::Throughput, "whether a run was slow is not known of many together");
  ensure(pending_.runs == 0, "whole replicates follow whole replicates");
  if (pool_.cells.empty()) return;
  std::uint64_t units = quiet.replicates;
  if (pool_.rule.unit == GateUnit::AgvHour) {
    Tally exposure;
    for (const std::uint32_t cell : pool_.cells) exposure.add(quiet.by_cell[cell]);
    units = exposure.agv_us;
  }
  pool_.units += units;
  pool_.most_units += units;
}

void PoolCounter::count_cells() {
  pool_.failing = pool_.failing_or_unknown = 0;
  for (std::size_t i = 0; i < by_cell_.size(); ++i) {
    by_cell_[i].add(pending_.by_cell[i]);
    pool_.failing = std::max(pool_.failing, by_cell_[i].failing);
    pool_.failing_or_unknown = std::max(pool_.failing_or_unknown, by_cell_[i].failing_or_unknown);
  }
}

}  // namespace fleetproof
