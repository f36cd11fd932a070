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
// Of the unit Run the counts are those of the cell with the most failures. Of the unit AgvHour a unit is a microsecond
// of one AGV, and `failing` counts worlds: the exposure of a world ends with the run that fails or stays unknown.
struct Pool {
  PoolRule rule;
  std::vector<std::uint32_t> cells;
  std::uint64_t units = 0, failing = 0, failing_or_unknown = 0;  // over complete replicates
  std::uint64_t failing_runs = 0;  // over all runs read so far; of Throughput: as `failing`
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
    std::uint64_t exposure_us = 0, transports_done = 0, agv_us = 0;
    bool foreign_body_lay = false;  // a low throughput is then no finding
    std::size_t runs = 0;
    std::vector<RunResult> by_cell;  // of the unit Run
  };

  RunResult result_of_run(const Outcome& outcome, RunResult violation);
  RunResult throughput_result(std::uint64_t transports_done, std::uint64_t agv_us, bool foreign_body_lay) const;
  void count_cells();

  Pool pool_;
  std::vector<Count> by_cell_;  // of the unit Run
  Pending pending_;
};

}  // namespace fleetproof
