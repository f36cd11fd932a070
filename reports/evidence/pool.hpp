#pragma once

#include <cstdint>
#include <vector>

#include "core/outcome/run_result.hpp"
#include "storage/folded_rows.hpp"
#include "storage/records.hpp"

namespace fleetproof {

// What is counted in a pool, and when it fails.
struct PoolRule {
  EndPoint end_point = EndPoint::Violation;
  GateUnit unit = GateUnit::World;
  double floor_per_agv_hour = 0.0;  // of the end point Throughput: a unit with fewer transports fails
};

// How often a unit failed, over complete replicates. `counted`: the units that a claim may count. A unit that passed
// counts only if it is distinct: the trace of one of its runs is new to its cell. Runs that repeat others are no
// evidence of their own.
struct UnitCount {
  std::uint64_t units = 0, distinct = 0, counted = 0;
  std::uint64_t failing = 0;
  std::uint64_t failing_or_unknown = 0;  // also if an audit of its runs failed or stayed unknown
};

// Several worlds, and all alike: their rate says nothing.
constexpr bool is_always_the_same(const UnitCount& count) { return count.units > 1 && count.distinct <= 1; }

// Cells that are judged together, and how often their unit failed. The unit is the world: one draw of all randomness,
// run in every cell. A world fails if any of its runs fails. Cells share worlds and are not independent, so their runs
// must not be counted one by one. With one cell, worlds are runs.
//
// If the unit is AgvHour, worlds are counted (hourly_rate.hpp).
struct Pool {
  PoolRule rule;
  std::vector<std::uint32_t> cells;
  UnitCount worlds;
  std::vector<UnitCount> runs_by_cell;  // of the unit Run, as `cells`
  // Over all runs read so far; of Throughput: worlds.
  std::uint64_t failing_runs = 0, failing_audits = 0;
};

// Counts a pool. Threads: one.
class PoolCounter {
 public:
  explicit PoolCounter(Pool pool);

  // The next run of one of the pool's cells, in order of run index. Returns what it says about the end point; the
  // throughput of a world is not known before the replicate is complete. `violation`: what it says about the end point
  // Violation, which is that of most pools. `audit`: what the run came to when it was simulated once more; null: the
  // same, or it was not.
  RunResult add(const RunRecord& run, RunResult violation, const AuditedOutcome* audit = nullptr);
  // All runs of the replicate were added.
  void finish_replicate();
  // Instead, for whole replicates in which nothing went wrong. Requires: the end point is not Throughput.
  void add(const QuietReplicates& quiet);
  const Pool& pool() const { return pool_; }

 private:
  // One unit, as far as it is known: the worst of its runs.
  struct Unit {
    RunResult result = RunResult::Passed;   // of the runs: Failed, then Unknown
    RunResult claimed = RunResult::Passed;  // of the runs and their audits
    bool is_distinct = false;
    void add(const Unit& run);
  };
  struct Work {
    std::uint64_t transports_done = 0, agv_us = 0;
    void add(const Work& run);
  };
  static Work work_of(const AuditedOutcome& audit);
  static void count(UnitCount& count, const Unit& unit);
  // Of the replicate that is not complete yet.
  struct Pending {
    Unit world;
    Work done, done_in_audits;      // in audits: of a run that came out the same, its own
    bool foreign_body_lay = false;  // a low throughput is then no finding
    std::vector<Unit> runs;
  };

  RunResult result_of_run(const Outcome& outcome, RunResult violation);
  RunResult result_of_audit(const AuditedOutcome& audit, bool foreign_body_lay) const;
  RunResult throughput_result(const Work& work, bool foreign_body_lay) const;

  Pool pool_;
  Pending pending_;
};

}  // namespace fleetproof
