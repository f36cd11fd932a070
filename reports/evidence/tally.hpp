#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "core/outcome/run_result.hpp"
#include "reports/evidence/exposure.hpp"
#include "storage/folded_rows.hpp"
#include "storage/records.hpp"

namespace fleetproof {

// Counts over the runs of one cell, or of several cells.
struct Tally {
  std::uint64_t runs = 0;
  std::uint64_t violating_runs = 0;  // runs that failed the end point violation
  std::uint64_t contact_runs = 0, hazardous_contact_runs = 0, stuck_runs = 0, crash_runs = 0, hang_runs = 0,
                indeterminate_runs = 0, engine_error_runs = 0;
  std::uint64_t unknown_runs = 0;     // runs in which that end point is unknown
  std::uint64_t repeats = 0;          // runs with a trace that an earlier run of their cell had
  std::uint64_t passing_repeats = 0;  // those of them that passed that end point
  std::uint64_t silent_runs = 0;      // of two or more AGVs, none of which sent a message
  std::uint64_t transports_done = 0;
  std::uint64_t agv_us = 0;           // AGVs x simulated time
  std::uint64_t longest_ns = 0;       // of one run
  std::uint32_t agvs = 0;             // the largest fleet
  std::uint64_t unmeasured_runs = 0;  // runs without a measured clearance
  std::optional<std::int64_t> min_clearance_um;

  // Of one run. `violation`: what it says about the end point Violation, which its reader asks for more than once.
  static Tally of(const RunRecord& run, RunResult violation);
  void add(const Tally& other);
  void add(const QuietRuns& quiet);
  double agv_hours() const { return fleetproof::agv_hours(agv_us); }
  // Absent if there is no simulated time.
  std::optional<double> transports_per_agv_hour() const;
};

}  // namespace fleetproof
