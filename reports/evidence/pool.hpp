#pragma once

#include <cstdint>
#include <vector>

#include "reports/evidence/run_result.hpp"
#include "storage/folded_rows.hpp"
#include "storage/records.hpp"

namespace fleetproof {

// What is counted in a pool, and when it fails.
struct PoolRule {
  EndPoint end_point = EndPoint::Violation;
  GateUnit unit = GateUnit::World;
  double floor_per_agv_hour = 0.0;  // of the end point Throughput: a unit with fewer transports fails
};

// Cells that are judged together, and how often their unit failed. The unit is the world: one draw of all randomness,
// run in every cell. A world fails if any of its runs fails. Cells share worlds and are not independent, so their runs
// must not be counted one by one. With one cell, worlds are runs.
//
// If the unit is Run, the counts are those of one cell: the cell with the most failures. If it is AgvHour, a unit is a
// microsecond of one AGV, and `failing` counts worlds: a world has one event at most, and is at risk until then
// (TimeAtRisk). Its runs count one after the other, in the order of the cells.
struct Pool {
  PoolRule rule;
  std::vector<std::uint32_t> cells;
  // Over complete replicates.
  std::uint64_t units = 0;       // AgvHour: at risk until a run failed or stayed unknown
  std::uint64_t most_units = 0;  // AgvHour: at risk until a run failed; otherwise as many as `units`
  std::uint64_t failing = 0, failing_or_unknown = 0;
  std::uint64_t failing_runs = 0;  // over all runs read so far; of Throughput: worlds, as `failing`
};

// Counts a pool. Threads: one.
class PoolCounter {
 public:
  explicit PoolCounter(Pool pool);

  // The next run of one of the pool's cells, in order of run index. Returns what it says about the end point; the
  // throughput of a world is not known before the replicate is complete. `violation`: what it says about the end point
  // Violation, which is that of most pools.
  RunResult add(const RunRecord& run, RunResult violation);
  // All runs of the replicate were added.
  void finish_replicate();
  // Instead, for whole replicates in which nothing went wrong. Requires: the end point is not Throughput.
  void add(const QuietReplicates& quiet);
  const Pool& pool() const { return pool_; }

 private:
  struct Count {
    std::uint64_t failing = 0, failing_or_unknown = 0;
    void add(RunResult result);
  };
  // Of the replicate that is not complete yet.
  struct Pending {
    RunResult result = RunResult::Passed;  // the worst so far: Failed, then Unknown
    TimeAtRisk at_risk;                    // of the unit AgvHour
    std::uint64_t transports_done = 0, agv_us = 0;
    bool foreign_body_lay = false;  // a low throughput is then no finding
    std::size_t runs = 0;
    std::vector<RunResult> by_cell;  // of the unit Run
  };

  RunResult result_of_run(const Outcome& outcome, RunResult violation);
  void add_time(const Outcome& outcome, RunResult result);
  RunResult throughput_result(std::uint64_t transports_done, std::uint64_t agv_us, bool foreign_body_lay) const;
  void count_cells();

  Pool pool_;
  std::vector<Count> by_cell_;  // of the unit Run
  Pending pending_;
};

}  // namespace fleetproof
