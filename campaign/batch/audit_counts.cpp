#include "campaign/batch/audit_counts.hpp"

namespace fleetproof {

AuditCounts::AuditCounts(const CampaignPlan& plan, const AgentPrograms& programs)
    : has_audits_(plan.audit.share > 0.0) {
  for (const AgentFactor& agent : plan.agents) agents_.push_back({programs.needs_worker(agent), {}});
}

void AuditCounts::add(const AuditedRun& finding) {
  AuditCount& count = agents_[agent_of(finding.audit.run_index)].count;
  ++count.audited;
  count.differing += finding.same ? 0 : 1;
}

bool AuditCounts::needs_recordings(std::size_t agent) const {
  const auto& [is_plugin, count] = agents_[agent];
  if (!has_audits_ || !is_plugin) return false;
  return count.audited < kAuditsToPass || count.differing > 0;
}

}  // namespace fleetproof
