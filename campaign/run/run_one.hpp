#pragma once

#include <cstdint>
#include <vector>

#include "campaign/plan/scenario_source.hpp"
#include "campaign/run/agent_programs.hpp"
#include "core/outcome/trace.hpp"
#include "storage/records.hpp"

namespace fleetproof {

// One run of a campaign, from its index only: scenario, agent, laws, outcome.
// Threads: any number.
class RunOne {
 public:
  // Throws InputError if an agent of the plan is not among the programs.
  RunOne(const CampaignPlan& plan, const AgentPrograms& programs);
  RunRecord operator()(std::uint64_t run_index, TraceSink* sink = nullptr) const;
  const ScenarioSource& scenarios() const { return scenarios_; }

 private:
  const CampaignPlan& plan_;
  ScenarioSource scenarios_;
  std::vector<const fp_agent_type*> agents_;  // by position in plan.agents
};

}  // namespace fleetproof
