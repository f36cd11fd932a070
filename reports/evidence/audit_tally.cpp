#include "reports/evidence/audit_tally.hpp"

#include <algorithm>

#include "core/base/error.hpp"

namespace fleetproof {

AuditTally::AuditTally(const CampaignRecord& campaign, const std::vector<CellRecord>& cells) {
  for (const CellRecord& cell : cells) {
    auto found = std::ranges::find(agents_, cell.agent, &AgentAudit::agent);
    if (found == agents_.end()) {
      found = agents_.insert(agents_.end(), AgentAudit());
      found->agent = cell.agent;
      found->is_plugin = std::ranges::find(campaign.plugin_agents, cell.agent) != campaign.plugin_agents.end();
    }
    agent_of_cell_.push_back(static_cast<std::size_t>(found - agents_.begin()));
  }
}

AgentAudit& AuditTally::agent_of(std::uint64_t run_index) {
  ensure(!agent_of_cell_.empty(), "a campaign with runs has cells");
  return agents_[agent_of_cell_[run_index % agent_of_cell_.size()]];
}

void AuditTally::add_run(const RunRecord& run) {
  if (run.outcome.is_failure()) ++agent_of(run.run_index).failed_runs;
}

void AuditTally::add_audit(std::uint64_t run_index, bool same) {
  AgentAudit& audit = agent_of(run_index);
  ++audit.audited;
  if (same) return;
  ++audit.differing;
  if (!audit.first_differing) audit.first_differing = run_index;
}

void AuditTally::add_recordings(const std::string& agent, std::uint64_t count) {
  const auto found = std::ranges::find(agents_, agent, &AgentAudit::agent);
  ensure(found != agents_.end(), "recordings belong to an agent of the campaign");
  found->recordings += count;
}

bool AuditTally::engine_at_fault() const { return std::ranges::any_of(agents_, &AgentAudit::engine_at_fault); }

}  // namespace fleetproof
