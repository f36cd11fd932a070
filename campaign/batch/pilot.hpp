#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "campaign/plan/plan.hpp"
#include "campaign/run/agent_programs.hpp"

namespace fleetproof {

// What the runs of one cell cost in a pilot.
struct CellCost {
  std::uint64_t runs = 0;
  double mean_s = 0.0;  // of one run, on one worker; without runs in the pilot: the mean of all cells
};

// A run of a pilot in which control software crashed or hung.
struct PilotFailure {
  std::uint64_t cell = 0;
  std::string message;
};

struct Pilot {
  std::vector<CellCost> cells;  // by cell
  int workers = 1;
  std::uint64_t runs = 0;
  double elapsed_s = 0.0;
  std::vector<PilotFailure> failures;
  // Audits simulate this share of the runs once more, and before that the first runs of each agent: so long, on one
  // worker.
  double audit_share = 0.0, first_audits_s = 0.0;

  double replicate_s() const;  // one run in each cell, on one worker, without audits
  // What `replicates` and their audits take on all workers.
  double forecast_s(std::uint64_t replicates) const;
  // The number of whole replicates that fit into a time.
  std::uint64_t replicates_within(double time_s) const;
  double runs_per_s() const;
};

// How much a pilot simulates at most.
struct PilotLength {
  std::chrono::milliseconds time{0};  // after that no run is begun
  std::uint64_t runs = std::numeric_limits<std::uint64_t>::max();
};

// Runs the first replicates of a plan to the length or to the end of the plan, and stores nothing. The cells of a
// replicate take turns in a spread order, so that a replicate that is longer than the pilot is sampled evenly. Each
// run that was begun is finished and counts: otherwise short runs would be over-represented.
Pilot run_pilot(const CampaignPlan& plan, const AgentPrograms& programs, int workers, PilotLength length);

}  // namespace fleetproof
