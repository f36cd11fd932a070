#pragma once

#include <cstdint>
#include <vector>

#include "campaign/batch/audit_queue.hpp"
#include "campaign/plan/plan.hpp"
#include "campaign/run/agent_programs.hpp"
#include "campaign/run/replay.hpp"

namespace fleetproof {

// What the audits so far say about each agent of a campaign.
class AuditCounts {
 public:
  AuditCounts(const CampaignPlan& plan, const AgentPrograms& programs);

  void add(const AuditedRun& finding);
  std::size_t agent_of(std::uint64_t run_index) const { return agent_of_run(run_index, agents_.size()); }
  std::size_t agent_count() const { return agents_.size(); }
  // Whether a failed run of this agent may not be reproduced by simulating it again: the agent has not passed its
  // audits. Without audits nothing is recorded.
  bool needs_recordings(std::size_t agent) const;

 private:
  struct Entry {
    bool is_plugin = false;
    AuditCount count;
  };
  bool has_audits_;
  std::vector<Entry> agents_;  // by position in plan.agents
};

}  // namespace fleetproof
