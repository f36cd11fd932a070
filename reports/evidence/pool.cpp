#include "reports/evidence/pool.hpp"

#include <algorithm>
#include <utility>

#include "core/base/error.hpp"
#include "core/outcome/foreign_bodies.hpp"
#include "core/outcome/work_and_progress.hpp"
#include "reports/evidence/exposure.hpp"

namespace fleetproof {
namespace {

RunResult worse(RunResult a, RunResult b) {
  if (a == RunResult::Failed || b == RunResult::Failed) return RunResult::Failed;
  return a == RunResult::Unknown || b == RunResult::Unknown ? RunResult::Unknown : RunResult::Passed;
}

}  // namespace

void PoolCounter::Unit::add(const Unit& run) {
  result = worse(result, run.result);
  claimed = worse(claimed, run.claimed);
  is_distinct |= run.is_distinct;
}

void PoolCounter::Work::add(const Work& run) {
  transports_done += run.transports_done;
  agv_us += run.agv_us;
}

PoolCounter::Work PoolCounter::work_of(const AuditedOutcome& audit) {
  return {audit.transports_done, agv_us(audit.simulated_ns, static_cast<std::uint32_t>(audit.agv_count))};
}

PoolCounter::PoolCounter(Pool pool) : pool_(std::move(pool)) {
  if (pool_.rule.unit == GateUnit::Run) pool_.runs_by_cell.resize(pool_.cells.size());
}

RunResult PoolCounter::add(const RunRecord& run, RunResult violation, const AuditedOutcome* audit) {
  const Outcome& outcome = run.outcome;
  Unit unit;
  unit.result = unit.claimed = result_of_run(outcome, violation);
  unit.is_distinct = !run.repeats;
  if (audit != nullptr) {
    const RunResult audited = result_of_audit(*audit, met_foreign_bodies(outcome));
    unit.claimed = worse(unit.claimed, audited);
    if (audited == RunResult::Failed) ++pool_.failing_audits;
  }
  if (unit.result == RunResult::Failed) ++pool_.failing_runs;
  pending_.world.add(unit);
  pending_.runs.push_back(unit);
  if (pool_.rule.end_point == EndPoint::Throughput) {
    pending_.foreign_body_lay |= met_foreign_bodies(outcome);
    const Work own{outcome.counters.transports_done, agv_us(outcome.simulated_ns, outcome.agv_count)};
    const Work audited = audit == nullptr ? own : work_of(*audit);
    pending_.done.add(own);
    pending_.done_in_audits.add(audited);
  }
  return unit.result;
}

RunResult PoolCounter::result_of_run(const Outcome& outcome, RunResult violation) {
  if (pool_.rule.end_point == EndPoint::Violation) return violation;
  if (pool_.rule.end_point != EndPoint::Throughput) return result_of(outcome, pool_.rule.end_point);
  // A crashed or hung AGV delivers nothing: that the fleet was slow then says nothing about its speed.
  if (result_of(outcome, EndPoint::Crash) != RunResult::Passed) return RunResult::Unknown;
  if (pool_.rule.unit != GateUnit::Run) return RunResult::Passed;  // the world decides
  return throughput_result({outcome.counters.transports_done, agv_us(outcome.simulated_ns, outcome.agv_count)},
                           met_foreign_bodies(outcome));
}

RunResult PoolCounter::result_of_audit(const AuditedOutcome& audit, bool foreign_body_lay) const {
  if (pool_.rule.end_point != EndPoint::Throughput) return result_of(audit.judged, pool_.rule.end_point);
  if (result_of(audit.judged, EndPoint::Crash) != RunResult::Passed) return RunResult::Unknown;
  if (pool_.rule.unit != GateUnit::Run) return RunResult::Passed;
  return throughput_result(work_of(audit), foreign_body_lay);
}

RunResult PoolCounter::throughput_result(const Work& work, bool foreign_body_lay) const {
  if (work.agv_us == 0) return RunResult::Unknown;
  const bool enough =
      transports_per_agv_hour(work.transports_done, agv_hours(work.agv_us)) >= pool_.rule.floor_per_agv_hour;
  if (enough) return RunResult::Passed;
  return foreign_body_lay ? RunResult::Unknown : RunResult::Failed;
}

void PoolCounter::finish_replicate() {
  if (pool_.cells.empty()) return;
  ensure(pending_.runs.size() == pool_.cells.size(), "a complete replicate has a run in every cell");
  Unit& world = pending_.world;
  if (pool_.rule.end_point == EndPoint::Throughput && pool_.rule.unit == GateUnit::World &&
      world.result == RunResult::Passed) {
    world.result = throughput_result(pending_.done, pending_.foreign_body_lay);
    pool_.failing_runs += world.result == RunResult::Failed ? 1 : 0;
    const RunResult audited = throughput_result(pending_.done_in_audits, pending_.foreign_body_lay);
    world.claimed = worse(worse(world.claimed, world.result), audited);
  }
  count(pool_.worlds, world);
  for (std::size_t i = 0; i < pool_.runs_by_cell.size(); ++i) count(pool_.runs_by_cell[i], pending_.runs[i]);
  pending_.world = Unit{};
  pending_.done = pending_.done_in_audits = Work{};
  pending_.foreign_body_lay = false;
  pending_.runs.clear();  // keeps its memory
}

void PoolCounter::count(UnitCount& count, const Unit& unit) {
  ++count.units;
  count.distinct += unit.is_distinct ? 1 : 0;
  count.counted += unit.is_distinct || unit.claimed != RunResult::Passed ? 1 : 0;
  count.failing += unit.result == RunResult::Failed ? 1 : 0;
  count.failing_or_unknown += unit.claimed == RunResult::Passed ? 0 : 1;
}

void PoolCounter::add(const QuietReplicates& quiet) {
  ensure(pool_.rule.end_point != EndPoint::Throughput, "whether a run was slow is not known of many together");
  ensure(pending_.runs.empty(), "whole replicates follow whole replicates");
  if (pool_.cells.empty()) return;
  const auto add_to = [&](UnitCount& count) {
    count.units += quiet.replicates;
    count.distinct += quiet.replicates;
    count.counted += quiet.replicates;
  };
  add_to(pool_.worlds);
  for (UnitCount& count : pool_.runs_by_cell) add_to(count);
}

}  // namespace fleetproof
