#pragma once

#include <cstdint>

#include "campaign/plan/plan.hpp"
#include "core/scenario/scenario.hpp"
#include "generators/map/rejection_counts.hpp"

namespace fleetproof {

// The cell, the replicate and the factors of one run.
struct RunPlace {
  std::uint64_t replicate = 0;
  CellRecord cell;
  FactorValues factors;  // the cell's, or what this replicate drew within its bounds
};

// run index -> scenario, a pure function of the plan; NoRoom (world_maker.hpp) if its seed has no room for the fleet.
// All agents and factors of a replicate get the same world. All worlds and agents of a replicate get the same draw of
// the continuous factors. Threads: any number.
class ScenarioSource {
 public:
  explicit ScenarioSource(const CampaignPlan& plan);
  RunPlace place(std::uint64_t run_index) const;
  Scenario scenario(std::uint64_t run_index) const;
  Scenario scenario(std::uint64_t run_index, RejectionCounts& rejected) const;  // adds the worlds that were rejected

  // The same in two steps. Runs that differ in factors or agent alone have the same world, and the same number of it.
  std::uint64_t world_number(std::uint64_t run_index) const { return run_index / plan_.cells_per_world(); }
  Scenario world(std::uint64_t run_index, RejectionCounts& rejected) const;
  Scenario in_world(const Scenario& world, std::uint64_t run_index) const;

 private:
  void add_computers(Scenario& scenario, const AgentFactor& agent) const;

  const CampaignPlan& plan_;
  std::vector<CellRecord> cells_;
  UnitSample sample_;
};

}  // namespace fleetproof
