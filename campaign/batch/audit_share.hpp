#pragma once

#include <cstdint>
#include <vector>

#include "campaign/plan/plan.hpp"
#include "campaign/run/agent_programs.hpp"
#include "storage/records.hpp"

namespace fleetproof {

// Which runs of a campaign are audited: one drawn run of every 1 / share of an agent, and before that its first run, or
// the first kAuditsToPass runs of a plug-in. A pure function of the plan's seed and the run, so that the same runs are
// audited however the campaign is stopped, resumed or shared out.
class AuditShare {
 public:
  AuditShare(const CampaignPlan& plan, const AgentPrograms& programs);

  // A run that hung is not audited: it would hang once more, for the whole limit.
  bool contains(const RunRecord& run) const;
  // So many runs of the agent at this position of the plan are audited before the share begins.
  std::uint64_t first_runs(std::size_t agent) const { return first_runs_[agent]; }

 private:
  std::uint64_t seed_;
  std::vector<std::uint64_t> first_runs_;  // by position in plan.agents: so many are audited
  std::uint64_t block_;                    // one run of so many runs of an agent; 0: none
};

}  // namespace fleetproof
